//! Names of files that every system takes.

/// Letters of the longest name that is taken into one of a file.
pub(super) const LONGEST: usize = 100;

/// Names that Windows keeps for devices, whatever stands behind a dot and in whatever case.
const RESERVED: [&str; 22] = [
    "con", "prn", "aux", "nul", "com1", "com2", "com3", "com4", "com5", "com6", "com7", "com8", "com9", "lpt1", "lpt2",
    "lpt3", "lpt4", "lpt5", "lpt6", "lpt7", "lpt8", "lpt9",
];

/// Whether a system keeps this name for a device.
pub(super) fn is_reserved(name: &str) -> bool {
    let stem = name.split('.').next().unwrap_or_default();
    RESERVED.iter().any(|reserved| reserved.eq_ignore_ascii_case(stem))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn devices_are_known_whatever_their_case_and_ending() {
        assert!(["con", "CON", "Lpt1.nodes.csv", "nul.txt"].into_iter().all(is_reserved));
        assert!(!["cone", "com", "com10", "_con", ""].into_iter().any(is_reserved));
    }
}
