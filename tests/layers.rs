//! The modules of `src` import in one direction only, and some words stand in some of them only.

use std::fs;
use std::path::Path;

/// Modules that may be used by those of later rows and by their own, not by others of the same row.
const ROWS: [&[&str]; 20] = [
    &["memory", "quantity", "number", "run_error"],
    &["geometry", "lanes", "document", "vtk_reader"],
    &["threads", "import", "packing"],
    &["contact", "bond", "motion", "surface"],
    &["exchange", "region"],
    &["scene"],
    &["parameters"],
    &["scene_file"],
    &["state"],
    &["coefficients"],
    &["neighbours", "boundaries", "batches"],
    &["integration", "interactions"],
    &["bond_passes"],
    &["stability", "books", "flow"],
    &["step"],
    &["statics", "averages"],
    &["interface"],
    &["results", "export"],
    &["run"],
    &["report"],
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
        .filter(|(module, _)| module != "lib")
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

/// Words that only some places of the sources may say.
struct Rule {
    /// The places that may.
    kept: &'static [&'static str],
    /// Where they are looked for.
    searched: &'static [&'static str],
    /// The words.
    words: &'static [&'static str],
    /// Why.
    why: &'static str,
}

/// Rooms with unsafe blocks, and how many each may have. `docs/architecture.md` says what they are for; a block more is
/// to be argued for there.
const UNSAFE: [(&str, usize); 12] = [
    ("lanes", 94),
    ("memory", 9),
    ("threads", 5),
    ("neighbours", 14),
    ("integration", 8),
    ("batches", 15),
    ("contact", 49),
    ("coefficients", 1),
    ("interactions", 22),
    ("bond_passes", 33),
    ("stability", 2),
    ("fmu", 37),
];

/// Lane widths and threads.
const LANES: Rule = Rule {
    kept: &[
        "src/lanes",
        "src/threads",
        "src/neighbours",
        "src/contact/batch",
        "src/batches",
        "src/coefficients.rs",
        "src/interactions",
        "src/bond_passes",
        "src/integration",
        "src/books",
        "src/step",
        "src/stability",
        "src/surface/feet.rs",
        "src/surface/mesh",
    ],
    searched: &["src", "fmu/src"],
    words: &["lanes::", "Width::", "Shared<", "Lane>", ": Lane"],
    why: "lane widths and threads are the business of the rooms that make a time step, and of meshes",
};

/// Intrinsics.
const INTRINSICS: Rule = Rule {
    kept: &["src/lanes", "src/memory.rs", "fmu/src/floating_point.rs"],
    searched: &["src", "fmu/src"],
    words: &["std::arch", "core::arch", "std::simd", "is_x86_feature_detected", "target_feature", "_mm"],
    why: "intrinsics stand with the lanes, where memory is asked for early, and where the unit leaves the floating-point environment of its host",
};

/// Functions that are not exactly rounded, and the fused operation.
#[rustfmt::skip]
const FUNCTIONS: Rule = Rule {
    kept: &[],
    searched: &["src", "fmu/src"],
    words: &[
        ".sin()", ".cos()", ".tan()", ".sin_cos()", ".asin()", ".acos()", ".atan()", ".atan2(", ".sinh()", ".cosh()",
        ".tanh()", ".exp()", ".exp2()", ".exp_m1()", ".ln()", ".ln_1p()", ".log(", ".log2()", ".log10()", ".powf(",
        ".cbrt()", ".hypot(", ".mul_add(", "f64::sin", "f64::cos", "f64::tan", "f64::exp", "f64::ln", "f64::powf",
        "f64::cbrt", "f64::hypot", "f64::mul_add", "f64::atan",
    ],
    why: "the platform's own functions differ from one processor to the next; those of libm do not",
};

/// What would make results depend on when and where they are computed.
const CHANCE: Rule = Rule {
    kept: &[],
    searched: &[
        "src/number.rs",
        "src/geometry",
        "src/contact",
        "src/bond",
        "src/packing",
        "src/scene",
        "src/scene_file",
        "src/state",
        "src/neighbours",
        "src/motion",
        "src/surface",
        "src/boundaries",
        "src/integration",
        "src/batches",
        "src/coefficients.rs",
        "src/interactions",
        "src/bond_passes",
        "src/stability",
        "src/books",
        "src/step",
    ],
    words: &["Instant", "SystemTime", "std::env", "HashMap", "HashSet"],
    why: "the same scene gives the same bits, whenever and wherever",
};

/// Adds the lines of a file, or of the files of a folder, that say one of the words; tests may.
fn find_words(path: &Path, rule: &Rule, faults: &mut Vec<String>) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    if path.ends_with("tests.rs") || rule.kept.iter().any(|place| path == root.join(place)) {
        return;
    }
    if path.is_dir() {
        for entry in fs::read_dir(path).unwrap() {
            find_words(&entry.unwrap().path(), rule, faults);
        }
        return;
    }
    let text = fs::read_to_string(path).unwrap();
    for (number, line) in (1..).zip(text.lines().take_while(|line| !line.starts_with("#[cfg(test)]"))) {
        let code = line.split("//").next().unwrap_or("");
        for word in rule.words.iter().filter(|word| code.contains(**word)) {
            faults.push(format!("{}:{number}: {word} stands here, and {}", path.display(), rule.why));
        }
    }
}

/// Kinds of motion.
const MOTIONS: Rule = Rule {
    kept: &["src/motion", "src/run/settle.rs"],
    searched: &["src", "fmu/src"],
    words: &[
        "AxisMotion::Fixed",
        "AxisMotion::Driven",
        "AxisMotion::Prescribed",
        "AxisMotion::Scheduled",
        "AxisMotion::Free",
        "AxisMotion::Loaded",
        "AxisMotion::Steered",
        "AxisMotion::Tabulated",
        "AxisMotion::Servo",
    ],
    why: "which motion an axis has is asked in its room alone; others ask what it can do",
};

#[test]
fn words_stand_where_they_belong() {
    let mut faults = Vec::new();
    for rule in [LANES, INTRINSICS, FUNCTIONS, CHANCE, MOTIONS] {
        for place in rule.searched {
            find_words(&Path::new(env!("CARGO_MANIFEST_DIR")).join(place), &rule, &mut faults);
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

#[test]
fn a_word_in_the_wrong_place_is_seen() {
    for (rule, place, most) in [(LANES, "src/contact/batch", 20), (INTRINSICS, "src/lanes", 100)] {
        let mut faults = Vec::new();
        find_words(&Path::new(env!("CARGO_MANIFEST_DIR")).join(place), &Rule { kept: &[], ..rule }, &mut faults);
        assert!(faults.len() > most, "{} places", faults.len());
    }
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

/// How many unsafe blocks and implementations a file, or the files of a folder, have outside of tests; and those without
/// an argument in the lines before.
fn unsafe_blocks(path: &Path, bare: &mut Vec<String>) -> usize {
    if path.is_dir() {
        return fs::read_dir(path).unwrap().map(|entry| unsafe_blocks(&entry.unwrap().path(), bare)).sum();
    }
    let text = fs::read_to_string(path).unwrap();
    let lines: Vec<&str> = text.lines().take_while(|line| !line.starts_with("#[cfg(test)]")).collect();
    let mut count = 0;
    for (number, line) in lines.iter().enumerate() {
        let code = line.split("//").next().unwrap_or("");
        let here = code.matches("unsafe {").count() + code.matches("unsafe impl").count();
        let argued = lines[number.saturating_sub(8)..=number].iter().any(|line| line.contains("SAFETY:"));
        if here > 0 && !argued {
            bare.push(format!("{}:{}", path.display(), number + 1));
        }
        count += here;
    }
    count
}

#[test]
fn unsafe_blocks_stand_in_named_rooms_with_an_argument_each() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut places = modules();
    places.push(("fmu".to_owned(), root.join("fmu/src")));
    places.push(("command".to_owned(), root.join("command/src")));
    places.push(("verify".to_owned(), root.join("verify/src")));
    places.push(("lib".to_owned(), root.join("src/lib.rs")));
    let mut bare = Vec::new();
    for (room, path) in places {
        let found = unsafe_blocks(&path, &mut bare);
        let most = UNSAFE.iter().find(|(name, _)| *name == room).map_or(0, |(_, most)| *most);
        assert!(found <= most, "{room} has {found} unsafe blocks, {most} are argued for");
    }
    assert!(bare.is_empty(), "without an argument: {bare:?}");
}
