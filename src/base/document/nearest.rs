//! The known word that a mistyped one most likely stands for.

/// The candidate nearest to `word`, if any is near enough to be meant.
pub(crate) fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let lower = word.to_lowercase();
    let permitted = (word.chars().count() / 3).max(2);
    candidates
        .into_iter()
        .map(|candidate| (likeness(&lower, candidate, permitted), candidate))
        .filter(|(distance, _)| *distance <= permitted && *distance < lower.chars().count())
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

/// How far two words are apart; words that contain one another or begin alike count as just near enough.
fn likeness(word: &str, candidate: &str, permitted: usize) -> usize {
    let known = candidate.to_lowercase();
    let distance = distance(word, &known);
    let shorter = word.len().min(known.len());
    let contained = shorter >= 4 && (word.contains(&known) || known.contains(word));
    let alike = word.chars().zip(known.chars()).take_while(|(a, b)| a == b).count() >= 5;
    if contained || alike { distance.min(permitted) } else { distance }
}

/// Levenshtein's distance: how many characters to insert, delete or replace.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, from) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, to) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(from != *to);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_insertions_deletions_and_replacements() {
        assert_eq!(distance("kitten", "sitting"), 3);
        assert_eq!(distance("", "abc"), 3);
    }

    #[test]
    fn finds_the_word_that_was_meant() {
        assert_eq!(nearest("radii", ["position", "radius", "density"]), Some("radius"));
        assert_eq!(nearest("friction_coefficient", ["restitution", "friction"]), Some("friction"));
    }

    #[test]
    fn proposes_nothing_for_a_word_like_no_other() {
        assert_eq!(nearest("colour", ["position", "radius", "density"]), None);
        assert_eq!(nearest("lj", ["si", "cgs"]), None);
    }
}
