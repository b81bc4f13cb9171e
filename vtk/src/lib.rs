//! VTK files as bytes, through vtkio.
//!
//! A crate of its own, so that vtkio's readers and writers, which are made anew for each kind of stream, are compiled beside the
//! library and not in it.

use vtkio::Vtk;
pub use vtkio::{IOBuffer, model};

/// Writes a file as XML.
///
/// # Errors
/// What vtkio says of data that it cannot write.
pub fn write(file: Vtk) -> Result<Vec<u8>, vtkio::Error> {
    let mut bytes = Vec::new();
    file.write_xml(&mut bytes)?;
    Ok(bytes)
}
