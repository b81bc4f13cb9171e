//! Lists of bonds as other programs write them: pairs of particles.

use std::collections::BTreeSet;

/// Why a text is not a list of bonds.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ListError {
    /// No form that is known.
    #[error(
        "expected a list of bonds (CSV with columns id1 and id2, a LAMMPS data file with a section Bonds, or a dump \
         of ENTRIES with columns id1 and id2 or batom1 and batom2), found none"
    )]
    Unknown,
    /// A row without two ids.
    #[error("line {line}: expected the ids of two particles, found {found:?}")]
    Row {
        /// Line in the text, from 1.
        line: usize,
        /// What stands there.
        found: String,
    },
    /// A particle bonded to itself.
    #[error("line {line}: expected two different particles, found particle {id} twice")]
    Itself {
        /// Line in the text, from 1.
        line: usize,
        /// The particle.
        id: u32,
    },
    /// A bond that stands in the list twice.
    #[error("line {line}: the bond of {0} and {1} stands in the list already", pair[0], pair[1])]
    Twice {
        /// Line in the text, from 1.
        line: usize,
        /// The ids.
        pair: [u32; 2],
    },
}

/// A line of a text: its number from 1, and its words.
type Line<'a> = (usize, Vec<&'a str>);

/// The bonded pairs of a list, in its order: CSV with columns `id1`, `id2`; a LAMMPS (or LIGGGHTS) data file with a section
/// `Bonds` (`number type id1 id2`); a dump of `ENTRIES` with columns `id1 id2` or `batom1 batom2`, of which
/// the last frame counts.
pub fn read(text: &str) -> Result<Vec<[u32; 2]>, ListError> {
    let lines: Vec<Line> = text
        .lines()
        .enumerate()
        .map(|(index, line)| {
            let bare = line.split('#').next().unwrap_or_default();
            (index + 1, bare.split([' ', '\t', ',', '\r']).filter(|word| !word.is_empty()).collect::<Vec<_>>())
        })
        .filter(|(_, words)| !words.is_empty())
        .collect();
    if let Some(last) = lines.iter().rposition(|(_, words)| words.starts_with(&["ITEM:", "ENTRIES"])) {
        let columns = columns(&lines[last].1[2..]).ok_or(ListError::Unknown)?;
        let rows = lines[last + 1..].iter().take_while(|(_, words)| words[0] != "ITEM:");
        return pairs(rows, columns);
    }
    if let Some(section) = lines.iter().position(|(_, words)| words[..] == ["Bonds"]) {
        let rows = lines[section + 1..].iter().take_while(|(_, words)| !words[0].starts_with(char::is_alphabetic));
        return pairs(rows, [2, 3]);
    }
    let header = lines.first().and_then(|(_, words)| columns(words)).ok_or(ListError::Unknown)?;
    pairs(lines[1..].iter(), header)
}

/// Where the two ids stand among named columns.
fn columns(names: &[&str]) -> Option<[usize; 2]> {
    let of = |wanted: &str| names.iter().position(|name| *name == wanted);
    [["id1", "id2"], ["batom1", "batom2"]].into_iter().find_map(|[one, other]| Some([of(one)?, of(other)?]))
}

/// The pairs in these columns of these rows.
fn pairs<'a>(rows: impl Iterator<Item = &'a Line<'a>>, columns: [usize; 2]) -> Result<Vec<[u32; 2]>, ListError> {
    let mut seen = BTreeSet::new();
    let mut pairs = Vec::new();
    for (line, words) in rows {
        let id = |column: usize| words.get(column).and_then(|word| word.parse::<u32>().ok());
        let (Some(one), Some(other)) = (id(columns[0]), id(columns[1])) else {
            return Err(ListError::Row { line: *line, found: words.join(" ") });
        };
        if one == other {
            return Err(ListError::Itself { line: *line, id: one });
        }
        if !seen.insert([one.min(other), one.max(other)]) {
            return Err(ListError::Twice { line: *line, pair: [one, other] });
        }
        pairs.push([one, other]);
    }
    Ok(pairs)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_form_gives_its_pairs() {
        assert_eq!(read("id1,id2\n1,2\n3,2\n"), Ok(vec![[1, 2], [3, 2]]));
        assert_eq!(read("time,id1,id2\n0.5, 7, 9\n"), Ok(vec![[7, 9]]));
        let data = "LAMMPS data\n\n3 atoms\n2 bonds\n\nAtoms\n\n1 1 0 0 0\n\nBonds # harmonic\n\n1 1 4 5\n2 1 5 6\n\nVelocities\n\n1 0 0 0\n";
        assert_eq!(read(data), Ok(vec![[4, 5], [5, 6]]));
        let dump = "ITEM: TIMESTEP\n0\nITEM: ENTRIES index batom1 batom2\n1 1 2\nITEM: TIMESTEP\n9\nITEM: ENTRIES index batom1 batom2\n1 2 3\n2 3 4\n";
        assert_eq!(read(dump), Ok(vec![[2, 3], [3, 4]]), "the last frame");
    }

    #[test]
    fn what_is_no_bond_is_refused_with_its_line() {
        assert_eq!(read(""), Err(ListError::Unknown));
        assert_eq!(read("a,b\n1,2\n"), Err(ListError::Unknown));
        assert_eq!(read("ITEM: ENTRIES c_1[1] c_1[2]\n1 2\n"), Err(ListError::Unknown));
        assert_eq!(read("id1,id2\n1,x\n"), Err(ListError::Row { line: 2, found: "1 x".to_owned() }));
        assert_eq!(read("id1,id2\n1\n"), Err(ListError::Row { line: 2, found: "1".to_owned() }));
        assert_eq!(read("id1,id2\n\n4,4\n"), Err(ListError::Itself { line: 3, id: 4 }));
        assert_eq!(read("id1,id2\n1,2\n2,1\n"), Err(ListError::Twice { line: 3, pair: [2, 1] }));
    }
}
