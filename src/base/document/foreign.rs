//! How to recognise a text that is not a scene.

use super::mistake::Mistake;

/// Commands that begin lines of input scripts of LIGGGHTS and LAMMPS and no line of TOML.
const COMMANDS: [&str; 24] = [
    "atom_modify",
    "atom_style",
    "boundary",
    "comm_modify",
    "communicate",
    "compute",
    "create_atoms",
    "create_box",
    "dump",
    "fix",
    "hard_particles",
    "neigh_modify",
    "neighbor",
    "newton",
    "pair_coeff",
    "pair_style",
    "processors",
    "read_data",
    "region",
    "run",
    "thermo",
    "timestep",
    "units",
    "variable",
];

/// A list of numbers with spaces between them, if a line has one, and what was expected.
pub(crate) fn list_without_commas(line: &str) -> Option<Mistake> {
    let content = line.split('#').next().unwrap_or_default();
    let is_number = |word: &str| word.parse::<f64>().is_ok();
    let rest = content.split_once('[')?.1;
    let words = |part: &str| part.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    let parts = rest.split([',', '[', ']', '{', '}', '=']).map(words);
    let mut lists = parts.filter(|words| words.len() > 1 && words.iter().all(|word| is_number(word)));
    lists.next().map(|words| Mistake::Unexpected {
        found: format!("{} without commas", words.join(" ")),
        expected: format!("a list with commas: {}", words.join(", ")),
    })
}

/// How many lines with commands tell a script.
const TELLING: usize = 3;

/// What the text looks like, and what was expected; nothing for what may be a scene with mistakes.
pub(crate) fn looks_like(text: &str) -> Option<Mistake> {
    let (found, expected) = if text.trim_start().is_empty() {
        return None;
    } else if text.starts_with("ITEM:") {
        ("a dump file of LIGGGHTS or LAMMPS", NAMED)
    } else if text.starts_with("<?xml") || text.starts_with("<VTKFile") || text.starts_with("# vtk DataFile") {
        ("a VTK file", NAMED)
    } else if is_script(text) {
        (
            "an input script of LIGGGHTS or LAMMPS",
            "a scene in TOML (docs/scene.md lists where each keyword of theirs is found)",
        )
    } else if is_data(text) {
        ("a data file of LIGGGHTS or LAMMPS", NAMED)
    } else if is_table(text) {
        ("a table of numbers", NAMED)
    } else {
        return None;
    };
    Some(Mistake::Unexpected { found: found.to_owned(), expected: expected.to_owned() })
}

/// What is right for files that hold particles.
const NAMED: &str = "a scene in TOML whose [particles.<name>] names this file";

/// Lines that hold something.
fn lines(text: &str) -> impl Iterator<Item = &str> {
    text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'))
}

/// Whether commands begin several lines.
fn is_script(text: &str) -> bool {
    let command = |line: &&str| {
        let mut words = line.split_whitespace();
        words.next().is_some_and(|word| COMMANDS.contains(&word)) && words.next().is_some_and(|word| word != "=")
    };
    lines(text).filter(command).take(TELLING).count() == TELLING
}

/// Whether there is a count of atoms and a section of them.
fn is_data(text: &str) -> bool {
    let counts = |line: &str| {
        let mut words = line.split_whitespace();
        words.next().is_some_and(|word| word.parse::<i64>().is_ok()) && words.next() == Some("atoms")
    };
    lines(text).take(100).any(counts)
}

/// Whether the second line is a row of numbers, parted as the first line is.
fn is_table(text: &str) -> bool {
    let mut lines = lines(text);
    let (Some(first), Some(second)) = (lines.next(), lines.next()) else { return false };
    let numbers = |line: &str, parted: fn(char) -> bool| {
        let words: Vec<&str> = line.split(parted).filter(|word| !word.trim().is_empty()).collect();
        let read = words.iter().filter(|word| word.trim().parse::<f64>().is_ok()).count();
        (words.len(), read)
    };
    let parts: [fn(char) -> bool; 3] =
        [|letter| letter == ',', |letter| letter == ';', |letter: char| letter.is_whitespace()];
    parts.into_iter().any(|parted| {
        let ((columns, _), (words, read)) = (numbers(first, parted), numbers(second, parted));
        words >= 3 && columns == words && 2 * read > words
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the text is taken for.
    fn taken_for(text: &str) -> String {
        looks_like(text).map(|mistake| mistake.to_string()).unwrap_or_default()
    }

    #[test]
    fn files_of_others_are_named() {
        assert!(taken_for("ITEM: TIMESTEP\n0\n").contains("found a dump file"));
        assert!(taken_for("x,y,z,radius\n0,0,0,1\n").contains("found a table of numbers"));
        assert!(taken_for("x y z radius\n0 0 0 1\n").contains("found a table of numbers"));
        assert!(taken_for("title\n\n2 atoms\n1 atom types\n").contains("found a data file"));
        let script = "atom_style granular\n# x\nunits si\nfix m1 all property/global youngsModulus\nrun 5\n";
        assert!(taken_for(script).contains("found an input script"));
    }

    #[test]
    fn a_scene_with_mistakes_is_none_of_them() {
        assert_eq!(taken_for("[run]\nend = = 1\nrun = 1\nunits = 2\nfix = 3\n"), "");
        assert_eq!(taken_for("gravity = [0, 0,\nlist = [1, 2, 3\n"), "");
    }
}
