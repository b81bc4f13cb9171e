//! The schema of the state: a number that differs when any struct or enumeration of `src/engine/state` does. A saved state carries it, so that a
//! program with other fields refuses the state in words.

use std::path::PathBuf;
use std::{env, fs};

/// Where the state is defined.
const FOLDER: &str = "src/engine/state";

fn main() {
    println!("cargo::rerun-if-changed={FOLDER}");
    let mut files: Vec<PathBuf> = fs::read_dir(FOLDER)
        .unwrap_or_else(|error| panic!("{FOLDER}: {error}"))
        .map(|entry| entry.unwrap_or_else(|error| panic!("{FOLDER}: {error}")).path())
        .collect();
    files.sort();
    let mut schema = String::new();
    for file in files {
        let text = fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        schema += &definitions(&text);
    }
    let folder = PathBuf::from(env::var_os("OUT_DIR").expect("cargo tells where"));
    fs::write(folder.join("state_schema.txt"), schema).expect("the folder of the build takes a file");
}

/// The structs and enumerations of a file, as rustfmt leaves them, without their comments.
fn definitions(text: &str) -> String {
    let (mut found, mut inside) = (String::new(), false);
    for line in text.lines().filter(|line| !line.trim_start().starts_with("//")) {
        let item = line.trim_start_matches("pub ").trim_start_matches("pub(crate) ");
        inside |= item.starts_with("struct ") || item.starts_with("enum ");
        if inside {
            found += line.trim();
            found.push('\n');
        }
        inside &= line != "}" && !line.ends_with(';');
    }
    found
}
