//! Shared libraries for tests: headers, the names of functions and the mark, and no code.

use super::LIBRARY_MARK;
use super::functions::FUNCTIONS;

/// What is made.
#[derive(Clone, Copy)]
pub(super) struct Sample {
    /// The kind of file.
    pub(super) format: Format,
    /// 32 or 64.
    pub(super) bits: u32,
    /// For Arm instead of x86.
    pub(super) arm: bool,
    /// The ELF header's number for the system.
    pub(super) system: u8,
    /// Whether it is a library and no program.
    pub(super) shared: bool,
    /// A function that is left out.
    pub(super) without: &'static str,
    /// What stands at its end.
    pub(super) mark: &'static str,
}

/// Kinds of files of machine code.
#[derive(Clone, Copy)]
pub(super) enum Format {
    /// Linux.
    Elf,
    /// Windows.
    Pe,
    /// macOS.
    MachO,
}

impl Sample {
    /// For Linux on x86-64.
    pub(super) const LINUX: Self =
        Self { format: Format::Elf, bits: 64, arm: false, system: 0, shared: true, without: "", mark: LIBRARY_MARK };
    /// For Windows on x86-64.
    pub(super) const WINDOWS: Self = Self { format: Format::Pe, ..Self::LINUX };
    /// For macOS on x86-64.
    pub(super) const MACOS: Self = Self { format: Format::MachO, ..Self::LINUX };

    /// The file.
    pub(super) fn bytes(self) -> Vec<u8> {
        let names: Vec<&str> = FUNCTIONS.concat().into_iter().filter(|name| *name != self.without).collect();
        let mut file = match self.format {
            Format::Elf => self.elf(&names),
            Format::Pe => self.pe(&names),
            Format::MachO => self.mach_o(&names),
        };
        file.extend_from_slice(self.mark.as_bytes());
        file
    }

    /// Header, a table of symbols, their names, and the headers of these two sections.
    fn elf(self, names: &[&str]) -> Vec<u8> {
        let wide = self.bits == 64;
        let (header, entry, symbol) = if wide { (64, 64, 24) } else { (52, 40, 16) };
        let (table, text) = (strings(names, ""), symbol * (names.len() + 1));
        let sections = header + text + table.bytes.len();
        let mut file = Bytes { bytes: b"\x7fELF".to_vec(), wide };
        file.all(&[if wide { 2 } else { 1 }, 1, 1, self.system, 0, 0, 0, 0, 0, 0, 0, 0]);
        let machine = match (self.arm, wide) {
            (false, true) => 62,
            (false, false) => 3,
            (true, true) => 183,
            (true, false) => 40,
        };
        file.halves(&[if self.shared { 3 } else { 2 }, machine]);
        file.word(1);
        file.address(0);
        file.address(0);
        file.address(sections);
        file.word(0);
        file.halves(&[header as u16, 0, 0, entry as u16, 3, 2]);
        file.all(&vec![0; symbol]);
        for name in &table.places {
            // Global, a function, in the first section.
            file.word(*name);
            if wide {
                file.all(&[0x12, 0, 1, 0]);
                file.address(0x1000);
                file.address(16);
            } else {
                file.address(0x1000);
                file.address(16);
                file.all(&[0x12, 0, 1, 0]);
            }
        }
        file.all(&table.bytes);
        let mut section = |kind: usize, at: usize, size: usize, link: usize, each: usize| {
            file.word(0);
            file.word(kind);
            file.addresses(&[0, 0, at, size]);
            file.word(link);
            file.word(1);
            file.addresses(&[8, each]);
        };
        section(0, 0, 0, 0, 0);
        section(11, header, text, 2, symbol);
        section(3, header + text, table.bytes.len(), 0, 0);
        file.bytes
    }

    /// The old header, the new one, one section, and in it the directory of exports with its tables.
    fn pe(self, names: &[&str]) -> Vec<u8> {
        /// Where the section stands in memory and in the file.
        const BASE: usize = 0x1000;
        const AT: usize = 0x200;
        let wide = self.bits == 64;
        let mut exports = Bytes::default();
        let (table, count) = (strings(names, ""), names.len());
        let texts = 40 + 10 * count;
        exports.words(&[
            0,
            0,
            0,
            BASE + texts,
            1,
            count,
            count,
            BASE + 40,
            BASE + 40 + 4 * count,
            BASE + 40 + 8 * count,
        ]);
        (0..count).for_each(|_| exports.word(0x10_0000));
        table.places.iter().for_each(|place| exports.word(BASE + texts + place));
        (0..count).for_each(|number| exports.halves(&[number as u16]));
        exports.all(&table.bytes);
        let size = exports.bytes.len();

        let mut file = Bytes { bytes: b"MZ".to_vec(), wide };
        file.bytes.resize(60, 0);
        file.word(64);
        file.all(b"PE\0\0");
        let optional = if wide { 240 } else { 224 };
        let machine = match (self.arm, wide) {
            (false, true) => 0x8664,
            (false, false) => 0x14c,
            (true, _) => 0xaa64,
        };
        file.halves(&[machine, 1]);
        file.words(&[0, 0, 0]);
        file.halves(&[optional, if self.shared { 0x2022 } else { 0x22 }]);
        let start = file.bytes.len();
        file.halves(&[if wide { 0x20b } else { 0x10b }]);
        // Sections and headers in memory are aligned by 4096, in the file by 512.
        file.bytes.resize(start + 32, 0);
        file.words(&[BASE, 512]);
        file.bytes.resize(start + usize::from(optional) - 132, 0);
        file.word(16);
        file.word(BASE);
        file.word(size);
        file.bytes.resize(start + usize::from(optional), 0);
        file.all(b".edata\0\0");
        file.words(&[size, BASE, size, AT, 0, 0, 0, 0x4000_0040]);
        file.bytes.resize(AT, 0);
        file.all(&exports.bytes);
        file.bytes
    }

    /// Header, one section, a table of symbols and their names.
    fn mach_o(self, names: &[&str]) -> Vec<u8> {
        let table = strings(names, "_");
        let mut file = Bytes { wide: true, ..Bytes::default() };
        let processor = if self.arm { 0x0100_000c } else { 0x0100_0007 };
        let symbols = 32 + 72 + 80 + 24;
        let text = symbols + 16 * names.len();
        file.words(&[0xfeed_facf, processor, 3, if self.shared { 6 } else { 2 }, 2, 72 + 80 + 24, 0, 0]);
        let name = |name: &str| [name.as_bytes(), &[0; 16]].concat()[..16].to_vec();
        file.words(&[0x19, 152]);
        file.all(&name("__TEXT"));
        file.addresses(&[0, 0x2000, 0, 0]);
        file.words(&[5, 5, 1, 0]);
        file.all(&[name("__text"), name("__TEXT")].concat());
        file.addresses(&[0x1000, 16]);
        file.words(&[0, 0, 0, 0, 0x8000_0400, 0, 0, 0]);
        file.words(&[2, 24, symbols, names.len(), text, table.bytes.len()]);
        for place in &table.places {
            file.word(*place);
            file.all(&[0x0f, 1, 0, 0]);
            file.address(0x1000);
        }
        file.all(&table.bytes);
        file.bytes
    }
}

/// One file for several processors.
pub(super) fn universal(parts: &[Sample]) -> Vec<u8> {
    let parts: Vec<Vec<u8>> = parts.iter().map(|part| part.bytes()).collect();
    let mut file: Vec<u8> = [0xcafe_babe_u32, parts.len() as u32].map(u32::to_be_bytes).concat();
    let mut at = 4096_usize;
    for part in &parts {
        // Its own header says which processor.
        let of = |from: usize| u32::from_le_bytes(part[from..from + 4].try_into().unwrap());
        file.extend([of(4), of(8), at as u32, part.len() as u32, 12].map(u32::to_be_bytes).concat());
        at += part.len().next_multiple_of(4096);
    }
    for part in &parts {
        file.resize(file.len().next_multiple_of(4096), 0);
        file.extend_from_slice(part);
    }
    file
}

/// A file that is being written, the lowest byte first.
#[derive(Default)]
struct Bytes {
    /// What there is of it.
    bytes: Vec<u8>,
    /// Whether addresses have eight bytes instead of four.
    wide: bool,
}

impl Bytes {
    /// Adds bytes.
    fn all(&mut self, bytes: &[u8]) {
        self.bytes.extend_from_slice(bytes);
    }

    /// Adds numbers of two bytes.
    fn halves(&mut self, values: &[u16]) {
        values.iter().for_each(|value| self.all(&value.to_le_bytes()));
    }

    /// Adds a number of four bytes.
    fn word(&mut self, value: usize) {
        self.all(&(value as u32).to_le_bytes());
    }

    /// Adds numbers of four bytes.
    fn words(&mut self, values: &[usize]) {
        values.iter().for_each(|value| self.word(*value));
    }

    /// Adds addresses.
    fn addresses(&mut self, values: &[usize]) {
        values.iter().for_each(|value| self.address(*value));
    }

    /// Adds an address.
    fn address(&mut self, value: usize) {
        if self.wide { self.all(&(value as u64).to_le_bytes()) } else { self.word(value) }
    }
}

/// Names, one after the other, and where each begins.
struct Strings {
    /// The names, each with a zero at its end, behind an empty one.
    bytes: Vec<u8>,
    /// Where they begin.
    places: Vec<usize>,
}

/// The names behind a prefix.
fn strings(names: &[&str], prefix: &str) -> Strings {
    let mut strings = Strings { bytes: vec![0], places: Vec::new() };
    for name in names {
        strings.places.push(strings.bytes.len());
        strings.bytes.extend_from_slice(format!("{prefix}{name}\0").as_bytes());
    }
    strings
}
