//! The modules of `src` import in one direction only.

use std::fs;
use std::path::Path;

/// Modules that may be used by those of later rows and by their own, not by others of the same row.
const ROWS: [&[&str]; 9] = [
    &["choices", "quantity", "number"],
    &["contact", "bond"],
    &["scene"],
    &["state"],
    &["step"],
    &["statics"],
    &["interface"],
    &["output", "export", "verify"],
    &["chart"],
];

/// Uses across rows that are forbidden all the same: the user, the used, why.
const FORBIDDEN: [(&str, &str, &str); 1] =
    [("state", "scene", "numbers that change know nothing of what a user wrote")];

/// The row of a module.
fn row(module: &str) -> Option<usize> {
    ROWS.iter().position(|row| row.contains(&module))
}

/// Whether a module may import another.
fn may_use(user: &str, used: &str) -> bool {
    let forbidden = FORBIDDEN.iter().any(|(a, b, _)| (*a, *b) == (user, used));
    user == used || (!forbidden && row(used) < row(user))
}

/// The modules that a line of code names after `crate::`.
fn used_in(line: &str) -> impl Iterator<Item = String> + '_ {
    let code = line.split("//").next().unwrap_or("");
    code.split("crate::")
        .skip(1)
        .map(|rest| rest.chars().take_while(|letter| letter.is_alphanumeric() || *letter == '_').collect())
}

/// Adds what a file, or the files of a folder, import against the order.
fn check(path: &Path, module: &str, faults: &mut Vec<String>) {
    if path.is_dir() {
        for entry in fs::read_dir(path).unwrap() {
            check(&entry.unwrap().path(), module, faults);
        }
        return;
    }
    for (number, line) in (1..).zip(fs::read_to_string(path).unwrap().lines()) {
        for used in used_in(line).filter(|used| row(used).is_some() && !may_use(module, used)) {
            faults.push(format!("{}:{number}: {module} may not use {used}", path.display()));
        }
        if line.contains("super::super::") {
            faults.push(format!("{}:{number}: a path climbs by super::super::", path.display()));
        }
    }
}

/// The modules of the library, from the files and folders of `src`.
fn modules() -> Vec<(String, std::path::PathBuf)> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut all: Vec<_> = fs::read_dir(source)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .map(|path| (path.file_stem().unwrap().to_str().unwrap().to_owned(), path))
        .filter(|(module, _)| !["lib", "main"].contains(&module.as_str()))
        .collect();
    all.sort();
    all
}

#[test]
fn no_module_uses_a_later_one() {
    let mut faults = Vec::new();
    for (module, path) in modules() {
        check(&path, &module, &mut faults);
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

#[test]
fn every_module_has_its_row() {
    let strangers: Vec<_> = modules().into_iter().filter(|(module, _)| row(module).is_none()).collect();
    assert!(strangers.is_empty(), "modules without a place in the order: {strangers:?}");
}

#[test]
fn no_module_has_a_name_that_says_nothing() {
    fn search(path: &Path, faults: &mut Vec<String>) {
        let stem = path.file_stem().unwrap().to_str().unwrap();
        if ["utils", "common", "manager", "base", "handler"].contains(&stem) {
            faults.push(path.display().to_string());
        }
        if path.is_dir() {
            for entry in fs::read_dir(path).unwrap() {
                search(&entry.unwrap().path(), faults);
            }
        }
    }
    let mut faults = Vec::new();
    for (_, path) in modules() {
        search(&path, &mut faults);
    }
    assert!(faults.is_empty(), "{faults:?}");
}

#[test]
fn an_import_against_the_order_is_seen() {
    assert_eq!(
        used_in("use crate::contact::Contact; use crate::step::Simulation;").collect::<Vec<_>>(),
        ["contact", "step"]
    );
    assert!(!may_use("quantity", "contact"));
    assert!(!may_use("contact", "bond"));
    assert!(!may_use("state", "scene"));
    assert!(may_use("scene", "contact"));
}
