//! Rooms are small enough to be known by heart, nothing in them goes in circles, and long files have a reason.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Lines that a room may have.
const ROOM: usize = 3000;

/// Lines that a file may have without a reason.
const FILE: usize = 300;

/// Files above that, each with its reason.
const LONG: [(&str, &str); 22] = [
    ("command/src/lib.rs", "one command after another; each is a few lines"),
    ("fmu/src/instance/mod.rs", "the life of an instance: every call that FMI allows in each of its states"),
    ("src/contact/batch/buffer.rs", "one buffer: its columns, and how each is written and read"),
    ("src/batches/mod.rs", "a batch from its entries to its loads, phase after phase"),
    ("src/bond/formulation/finite_rotation.rs", "one formulation, with the tests that its equations are held to"),
    ("src/bond_passes/batch.rs", "the four stages of a pass, which hand columns to each other"),
    ("src/bond_passes/mod.rs", "the pass over bonds: what it begins with, asks for and leaves"),
    ("src/bond_passes/pipeline_buffer.rs", "one buffer: its columns, and how each is written and read"),
    ("src/bond_passes/walls.rs", "bonds to planes: the pass, its books and its records"),
    ("src/contact/law.rs", "what a law says of one contact, sub-model by sub-model"),
    ("src/contact/normal/eepa.rs", "one sub-model, with the tests that its branches are held to"),
    ("src/export/tests.rs", "tests"),
    ("src/interactions/suppression.rs", "the life of a suppressed contact: entered, carried, released"),
    ("src/interactions/surfaces/mod.rs", "the pass over surfaces: what it begins with, asks for and leaves"),
    ("src/neighbours/mod.rs", "when lists are made, and what they are made of"),
    ("src/region/solid_tests.rs", "tests"),
    ("src/results/boundaries.rs", "one cloud, with the tests that its sums are held to"),
    ("src/stability/lanczos.rs", "one proof: iteration and certificate share their vectors"),
    ("src/state/check.rs", "each part of the state looks through itself: one function a part"),
    ("src/step/time_step.rs", "the order of one time step"),
    ("src/threads/helpers.rs", "one protocol, with the tests of its interleavings"),
    ("verify/src/case.rs", "a case as it is written, field by field"),
];

/// Folders that are rooms of their own though they stand inside of another.
const INNER_ROOMS: [&str; 11] = [
    "contact/batch",
    "contact/normal",
    "contact/tangential",
    "contact/rolling",
    "contact/cohesion",
    "bond/formulation",
    "bond/damping",
    "bond/breakage",
    "interactions/surfaces",
    "step/taken_over",
    "surface/mesh",
];

/// Files and folders that still go in circles: the folder, and those in it that do.
const CIRCLES: [(&str, &[&str]); 0] = [];

/// A file of the library.
struct Source {
    /// Its module: `["bond", "law"]`.
    module: Vec<String>,
    /// Its text without comments and tests.
    code: String,
}

/// Everything in a folder, folders in it included.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut all: Vec<PathBuf> = entries
        .flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] })
        .filter(|path| path.extension().is_some_and(|ending| ending == "rs"))
        .collect();
    all.sort();
    all
}

/// The root of the library.
fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A path below `src` as it is shown: `bond/law.rs`.
fn shown(path: &Path) -> String {
    path.strip_prefix(root().join("src")).unwrap_or(path).display().to_string()
}

/// How many lines a file has.
fn lines(path: &Path) -> usize {
    fs::read_to_string(path).unwrap().lines().count()
}

/// What a text says to the compiler outside of tests.
fn code_of(text: &str) -> String {
    let mut code = String::new();
    let mut lines = text.lines().map(|line| line.split("//").next().unwrap_or(""));
    while let Some(line) = lines.next() {
        match line.trim() {
            "#[cfg(test)]" => match lines.next() {
                Some(next) if next.ends_with('{') => break,
                _ => {}
            },
            line => code = code + line + "\n",
        }
    }
    code
}

/// The files of the library but `lib.rs` and tests.
fn sources() -> Vec<Source> {
    let mut all = Vec::new();
    for path in files(&root().join("src")) {
        let name = shown(&path.with_extension(""));
        if ["tests", "fixtures", "lib"].iter().any(|tests| name.split('/').any(|part| part == *tests)) {
            continue;
        }
        let mut module: Vec<String> = name.split('/').map(str::to_owned).collect();
        if module.last().is_some_and(|last| last == "mod") {
            module.pop();
        }
        all.push(Source { module, code: code_of(&fs::read_to_string(&path).unwrap()) });
    }
    all
}

/// The paths of a `use`: `a::{b, c::{d, e}}` is `a::b`, `a::c::d`, `a::c::e`.
fn expanded(tree: &str) -> Vec<String> {
    let tree: String = tree.split_whitespace().collect::<Vec<_>>().join(" ");
    let Some((before, rest)) = tree.split_once('{') else {
        return vec![tree.split(" as ").next().unwrap_or("").trim().to_owned()];
    };
    let inside = &rest[..rest.rfind('}').unwrap_or(rest.len())];
    let mut parts = vec![String::new()];
    let mut depth = 0;
    for letter in inside.chars() {
        depth += i32::from(letter == '{') - i32::from(letter == '}');
        match letter {
            ',' if depth == 0 => parts.push(String::new()),
            letter => parts.last_mut().unwrap().push(letter),
        }
    }
    let parts = parts.iter().map(|part| part.trim()).filter(|part| !part.is_empty());
    parts.flat_map(|part| expanded(&format!("{}{part}", before.trim()))).collect()
}

/// The paths that some code names: those of its `use`, and others that begin with `crate` or `super`.
fn paths(code: &str) -> Vec<String> {
    let mut found = Vec::new();
    for piece in code.split("use ").skip(1) {
        found.extend(expanded(piece.split(';').next().unwrap_or("")));
    }
    for word in code.split(|letter: char| !(letter.is_alphanumeric() || letter == '_' || letter == ':')) {
        if (word.starts_with("crate::") || word.starts_with("super::")) && !word.ends_with(':') {
            found.push(word.to_owned());
        }
    }
    found
}

/// A path from the root of the library, as seen from a module.
fn absolute(module: &[String], path: &str) -> Option<Vec<String>> {
    let mut parts = path.split("::").map(|part| part.trim().to_owned()).peekable();
    let mut from = match parts.next()?.as_str() {
        "crate" => Vec::new(),
        "super" => module[..module.len() - 1].to_vec(),
        "self" => module.to_vec(),
        child => [module, &[child.to_owned()]].concat(),
    };
    while parts.next_if(|part| part == "super").is_some() {
        from.pop();
    }
    from.extend(parts.filter(|part| part != "self"));
    Some(from)
}

/// Who uses whom among the files and folders of one folder. What its index, `mod.rs`, hands on counts as a use of the
/// file where it stands; the index itself, which lists all of them, does not count.
fn uses_in(folder: &[String], sources: &[Source]) -> BTreeMap<String, BTreeSet<String>> {
    let depth = folder.len();
    let inside = |module: &[String]| module.len() > depth && module[..depth] == *folder;
    let children: BTreeSet<&String> =
        sources.iter().filter(|source| inside(&source.module)).map(|source| &source.module[depth]).collect();
    let index = sources.iter().find(|source| source.module == folder);
    let handed_on: BTreeMap<String, String> = index
        .iter()
        .flat_map(|index| paths(&index.code).into_iter().filter_map(|path| absolute(folder, &path)))
        .filter(|path| path.len() > depth + 1 && inside(path) && children.contains(&path[depth]))
        .map(|path| (path.last().unwrap().clone(), path[depth].clone()))
        .collect();
    let mut uses: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for source in sources.iter().filter(|source| inside(&source.module)) {
        let user = &source.module[depth];
        for path in paths(&source.code).iter().filter_map(|path| absolute(&source.module, path)) {
            if !inside(&path) {
                continue;
            }
            let used = if children.contains(&path[depth]) { Some(&path[depth]) } else { handed_on.get(&path[depth]) };
            if let Some(used) = used.filter(|used| *used != user) {
                uses.entry(user.clone()).or_default().insert(used.clone());
            }
        }
    }
    uses
}

/// Those that come back to themselves.
fn in_circles(uses: &BTreeMap<String, BTreeSet<String>>) -> Vec<&str> {
    let reached = |start: &String| {
        let mut seen: BTreeSet<&String> = BTreeSet::new();
        let mut next: Vec<&String> = uses[start].iter().collect();
        while let Some(one) = next.pop() {
            if seen.insert(one) {
                next.extend(uses.get(one).into_iter().flatten());
            }
        }
        seen.contains(start)
    };
    uses.keys().filter(|name| reached(name)).map(String::as_str).collect()
}

#[test]
fn nothing_inside_a_room_goes_in_circles() {
    let sources = sources();
    let folders: BTreeSet<Vec<String>> = sources
        .iter()
        .flat_map(|source| (0..source.module.len()).map(|depth| source.module[..depth].to_vec()))
        .collect();
    let mut faults = Vec::new();
    for folder in folders {
        let name = folder.join("/");
        let uses = uses_in(&folder, &sources);
        let known = CIRCLES.iter().find(|(place, ..)| *place == name).map_or(&[][..], |(_, files)| files);
        let found = in_circles(&uses);
        if found != known {
            let of = |name: &&str| format!("{name} uses {:?}", uses[*name].iter().collect::<Vec<_>>());
            faults.push(format!(
                "src/{name}: {}; {known:?} are known",
                found.iter().map(of).collect::<Vec<_>>().join(", ")
            ));
        }
    }
    assert!(faults.is_empty(), "circles:\n{}", faults.join("\n"));
}

#[test]
fn a_circle_is_seen() {
    let source = |module: &[&str], code: &str| Source {
        module: module.iter().map(|part| (*part).to_owned()).collect(),
        code: code.to_owned(),
    };
    let sources = [
        source(&["room"], "pub use law::{Law, Other};"),
        source(&["room", "law"], "use super::{keys::Keys, nothing};"),
        source(&["room", "keys"], "use crate::room::Law;"),
        source(&["room", "alone"], "use super::law;"),
    ];
    assert_eq!(in_circles(&uses_in(&["room".to_owned()], &sources)), ["keys", "law"]);
}

/// The room that a file belongs to.
fn room_of(name: &str) -> &str {
    let inner = INNER_ROOMS.iter().find(|room| name.strip_prefix(**room).is_some_and(|rest| rest.starts_with('/')));
    inner.copied().unwrap_or_else(|| name.split('/').next().unwrap_or(name))
}

#[test]
fn no_room_is_too_large_to_be_known() {
    let mut rooms: BTreeMap<String, usize> = BTreeMap::new();
    for path in files(&root().join("src")) {
        *rooms.entry(room_of(&shown(&path)).to_owned()).or_default() += lines(&path);
    }
    let large: Vec<_> = rooms.iter().filter(|(_, lines)| **lines > ROOM).collect();
    assert!(large.is_empty(), "rooms with more than {ROOM} lines: {large:?}");
}

#[test]
fn a_file_is_short_or_has_a_reason() {
    let places = ["src", "command/src", "fmu/src", "verify/src", "chart/src"].map(|place| root().join(place));
    let long = places.iter().flat_map(|place| files(place)).filter(|path| lines(path) > FILE);
    let long: Vec<String> = long.map(|path| path.strip_prefix(root()).unwrap().display().to_string()).collect();
    let unknown: Vec<_> = long.iter().filter(|path| !LONG.iter().any(|(name, _)| name == path)).collect();
    assert!(unknown.is_empty(), "more than {FILE} lines: divide them, or say in tests/rooms.rs why not: {unknown:?}");
    let short: Vec<_> = LONG.iter().filter(|(name, _)| !long.iter().any(|path| path == name)).collect();
    assert!(short.is_empty(), "no longer long, to be taken from the list: {short:?}");
}

/// The tests that Cargo does not find by itself: those that no program of tests names would never run.
#[test]
fn every_file_of_tests_is_part_of_a_program() {
    let tests = root().join("tests");
    let programs = fs::read_to_string(root().join("Cargo.toml")).unwrap();
    let modules = fs::read_to_string(tests.join("main.rs")).unwrap();
    let is_named = |name: &str| {
        modules.contains(&format!("mod {name};\n")) || programs.contains(&format!("[[test]]\nname = \"{name}\""))
    };
    let found: Vec<String> = fs::read_dir(&tests)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "rs") || path.join("mod.rs").exists())
        .map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned())
        .filter(|name| name != "main")
        .collect();
    assert!(found.len() > 30, "{found:?}");
    let lost: Vec<_> = found.iter().filter(|name| !is_named(name)).collect();
    assert!(lost.is_empty(), "in no program: {lost:?}");
}
