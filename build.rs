//! Two marks. The schema of the state differs when any struct or enumeration of `src/engine/state` does: a saved state carries it, so that a
//! program with other fields refuses the state in words. The build differs when any source does: a library of units carries it.

use std::path::{Path, PathBuf};
use std::{env, fs};

/// All sources.
const SOURCES: &str = "src";

/// Where the state is defined.
const STATE: &str = "src/engine/state";

fn main() {
    println!("cargo::rerun-if-changed={SOURCES}");
    let (mut schema, mut build) = (String::new(), FNV_BASIS);
    for file in files(Path::new(SOURCES)) {
        let text = fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        build = text.lines().fold(build, |hash, line| fnv(hash, line.as_bytes()));
        if file.parent() == Some(Path::new(STATE)) {
            schema += &definitions(&text);
        }
    }
    let folder = PathBuf::from(env::var_os("OUT_DIR").expect("cargo tells where"));
    fs::write(folder.join("state_schema.txt"), schema).expect("the folder of the build takes a file");
    println!("cargo::rustc-env=COGRAIN_BUILD={build:016x}");
}

/// The source files in a folder and below it, in order.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry is read").path()).collect();
    paths.sort();
    let is_source = |path: &PathBuf| path.extension().is_some_and(|extension| extension == "rs");
    let each = paths.into_iter();
    each.flat_map(|path| if path.is_dir() { files(&path) } else { Vec::from_iter(Some(path).filter(is_source)) })
        .collect()
}

/// Where the hash of Fowler, Noll and Vo begins.
const FNV_BASIS: u64 = 0xcbf2_9ce4_8422_2325;

/// Goes on with it over a line.
fn fnv(hash: u64, line: &[u8]) -> u64 {
    line.iter().chain(b"\n").fold(hash, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3))
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
