//! VTK files as bytes, through vtkio.
//!
//! A crate of its own, so that vtkio's readers and writers, which are made anew for each kind of stream, are compiled beside the
//! library and not in it.

use vtkio::Vtk;
use vtkio::xml::Compressor;
pub use vtkio::{IOBuffer, model};

/// How hard arrays are compressed: as fast as zlib can.
const LEVEL: u32 = 1;

/// Writes a file as XML, whose arrays zlib may compress.
///
/// # Errors
/// What vtkio says of data that it cannot write.
pub fn write(file: Vtk, compressed: bool) -> Result<Vec<u8>, vtkio::Error> {
    let compressor = if compressed { Compressor::ZLib } else { Compressor::None };
    let mut bytes = Vec::new();
    file.try_into_xml_format(compressor, LEVEL)?.write(&mut bytes)?;
    Ok(bytes)
}
