//! The folders of `src` are floors: each uses itself and the floors below it.

use std::fs;
use std::path::{Path, PathBuf};

/// The floors, lowest first.
const FLOORS: [&str; 6] = ["base", "laws", "scene", "engine", "interface", "output"];

/// Every source file of a folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let paths = entries.map(|entry| entry.expect("a folder can be listed").path());
    let all = paths.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] });
    all.filter(|path| path.extension().is_some_and(|ending| ending == "rs")).collect()
}

/// The first names after `crate::` in some code: `crate::{base::number, laws::bond}` has two.
fn used(code: &str) -> Vec<String> {
    let word = |text: &str| text.chars().take_while(|letter| letter.is_alphanumeric() || *letter == '_').collect();
    let mut found = Vec::new();
    for rest in code.split("crate::").skip(1) {
        let Some(list) = rest.strip_prefix('{') else {
            found.push(word(rest));
            continue;
        };
        let (mut depth, mut begins) = (0, true);
        for (place, letter) in list.char_indices() {
            match letter {
                '{' => depth += 1,
                '}' if depth == 0 => break,
                '}' => depth -= 1,
                ',' if depth == 0 => begins = true,
                letter if begins && !letter.is_whitespace() => {
                    found.push(word(&list[place..]));
                    begins = false;
                }
                _ => {}
            }
        }
    }
    found
}

#[test]
fn every_floor_uses_itself_and_those_below() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut faults = Vec::new();
    for (height, floor) in FLOORS.into_iter().enumerate() {
        for path in files(&source.join(floor)) {
            let text = fs::read_to_string(&path).expect("sources are text");
            let code: String =
                text.lines().map(|line| line.split("//").next().unwrap_or("").to_owned() + "\n").collect();
            for name in used(&code) {
                if FLOORS[height + 1..].contains(&name.as_str()) {
                    faults.push(format!("{}: {floor} uses {name}, which is above", path.display()));
                }
            }
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

#[test]
fn every_source_file_is_on_a_floor() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let entries = fs::read_dir(&source).expect("there is a folder of sources");
    let names = entries.map(|entry| entry.expect("it can be listed").file_name().to_string_lossy().into_owned());
    let others: Vec<_> = names.filter(|name| name != "lib.rs" && !FLOORS.contains(&name.as_str())).collect();
    assert!(others.is_empty(), "beside the floors: {others:?}");
}

#[test]
fn names_after_crate_are_found_in_lists_too() {
    let code = "use crate::{base::{number, lanes}, output}; let a = crate::laws::bond::Law; crate::scene!();";
    assert_eq!(used(code), ["base", "output", "laws", "scene"]);
}
