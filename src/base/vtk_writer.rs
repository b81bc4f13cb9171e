//! XML files of VTK, written piece by piece: arrays stand in the text as base64, in the order of bytes of this processor.

use base64::prelude::BASE64_STANDARD;
use base64::write::EncoderWriter;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::fmt;
use std::io::{self, Write};

/// The numbers of an array.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Numbers<'a> {
    /// Real numbers.
    Reals(&'a [f64]),
    /// Whole numbers.
    Integers(&'a [i64]),
    /// Places in other arrays.
    Places(&'a [u64]),
    /// Small whole numbers.
    Bytes(&'a [u8]),
}

impl<'a> Numbers<'a> {
    /// Their type, as VTK calls it.
    fn kind(self) -> &'static str {
        match self {
            Self::Reals(_) => "Float64",
            Self::Integers(_) => "Int64",
            Self::Places(_) => "UInt64",
            Self::Bytes(_) => "UInt8",
        }
    }

    /// The same as bytes.
    fn bytes(self) -> &'a [u8] {
        match self {
            Self::Reals(numbers) => bytemuck::cast_slice(numbers),
            Self::Integers(numbers) => bytemuck::cast_slice(numbers),
            Self::Places(numbers) => bytemuck::cast_slice(numbers),
            Self::Bytes(numbers) => numbers,
        }
    }

    /// The least and the largest one; nothing where there are none.
    fn range(self) -> Option<[f64; 2]> {
        let ends = |least: fn(f64, f64) -> f64, numbers: &[f64]| numbers.iter().copied().reduce(least);
        Some(match self {
            Self::Reals(numbers) => [ends(f64::min, numbers)?, ends(f64::max, numbers)?],
            Self::Integers(numbers) => [*numbers.iter().min()? as f64, *numbers.iter().max()? as f64],
            Self::Places(numbers) => [*numbers.iter().min()? as f64, *numbers.iter().max()? as f64],
            Self::Bytes(numbers) => [f64::from(*numbers.iter().min()?), f64::from(*numbers.iter().max()?)],
        })
    }
}

/// An array of a file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Array<'a> {
    /// Its name.
    pub name: &'a str,
    /// Numbers of each point or cell.
    pub components: usize,
    /// Names of these numbers, if they have any.
    pub named: &'a [String],
    /// All numbers, point after point or cell after cell.
    pub numbers: Numbers<'a>,
}

impl Array<'_> {
    /// Whether readers take it for a vector in space.
    fn is_vector(&self) -> bool {
        self.components == 3 && matches!(self.numbers, Numbers::Reals(_))
    }
}

/// Bytes of an array that are compressed together.
const BLOCK: usize = 1 << 16;

/// A file that is being written.
pub(crate) struct File<W> {
    /// Where to.
    out: W,
    /// Whether arrays are compressed by zlib.
    compressed: bool,
}

impl<W: Write> File<W> {
    /// Begins a file of this kind of data.
    pub(crate) fn begin(mut out: W, kind: &str, compressed: bool) -> io::Result<Self> {
        let order = if cfg!(target_endian = "little") { "LittleEndian" } else { "BigEndian" };
        write!(out, "<VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"{order}\" header_type=\"UInt64\"")?;
        let told = if compressed { " compressor=\"vtkZLibDataCompressor\">" } else { ">" };
        out.write_all(told.as_bytes())?;
        Ok(Self { out, compressed })
    }

    /// Writes text: tags.
    pub(crate) fn write_fmt(&mut self, text: fmt::Arguments<'_>) -> io::Result<()> {
        self.out.write_fmt(text)
    }

    /// Writes the arrays of the points or cells behind this tag; nothing where there are none. Readers show the first one at once.
    pub(crate) fn attributes(&mut self, tag: &str, arrays: &[Array<'_>]) -> io::Result<()> {
        if arrays.is_empty() {
            return Ok(());
        }
        write!(self, "<{tag}")?;
        for (key, vectors) in [("Scalars", false), ("Vectors", true)] {
            if let Some(first) = arrays.iter().find(|array| array.is_vector() == vectors) {
                write!(self, " {key}=\"{}\"", first.name)?;
            }
        }
        write!(self, ">")?;
        arrays.iter().try_for_each(|array| self.array(array))?;
        write!(self, "</{tag}>")
    }

    /// Writes an array.
    pub(crate) fn array(&mut self, &Array { name, components, named, numbers }: &Array<'_>) -> io::Result<()> {
        write!(self, "<DataArray type=\"{}\" Name=\"{name}\"", numbers.kind())?;
        for (place, own) in named.iter().enumerate() {
            write!(self, " ComponentName{place}=\"{own}\"")?;
        }
        if components != 1 {
            write!(self, " NumberOfComponents=\"{components}\"")?;
        }
        write!(self, " format=\"binary\"")?;
        if let Some([least, most]) = numbers.range() {
            write!(self, " RangeMin=\"{least}\" RangeMax=\"{most}\"")?;
        }
        write!(self, ">")?;
        let bytes = numbers.bytes();
        if self.compressed {
            let blocks = bytes.chunks(BLOCK).map(deflated).collect::<io::Result<Vec<_>>>()?;
            let lengths = [blocks.len(), BLOCK, bytes.len() % BLOCK].into_iter().chain(blocks.iter().map(Vec::len));
            let lengths: Vec<u64> = lengths.map(|length| length as u64).collect();
            self.base64([bytemuck::cast_slice(&lengths)].into_iter())?;
            self.base64(blocks.iter().map(Vec::as_slice))?;
        } else {
            self.base64([&(bytes.len() as u64).to_ne_bytes()[..], bytes].into_iter())?;
        }
        write!(self, "</DataArray>")
    }

    /// Writes these bytes, one part behind the other, as one text.
    fn base64<'a>(&mut self, mut parts: impl Iterator<Item = &'a [u8]>) -> io::Result<()> {
        let mut text = EncoderWriter::new(&mut self.out, &BASE64_STANDARD);
        parts.try_for_each(|part| text.write_all(part))?;
        text.finish().map(drop)
    }

    /// Ends the file.
    pub(crate) fn end(mut self) -> io::Result<()> {
        write!(self, "</VTKFile>")
    }
}

/// A block as zlib makes it quickly.
fn deflated(block: &[u8]) -> io::Result<Vec<u8>> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(block)?;
    encoder.finish()
}
