//! A grid without time as a VTK XML unstructured grid (`.vtu`), for viewers that read no VTKHDF.

use crate::files::made::XML_MARK;
use crate::grid::{GridSpec, Values};
use crate::{Cells, OutputError};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

/// Writes points, cells and constant fields of `grid` to `path`, raw little-endian numbers
/// appended to the XML header.
///
/// # Errors
/// A file that cannot be written.
pub fn write_vtu(path: impl AsRef<Path>, grid: &GridSpec<'_>) -> Result<(), OutputError> {
    let path = path.as_ref();
    write(path, grid)
        .map_err(|error| OutputError::Create { path: path.to_owned(), reason: error.to_string() })
}

fn write(path: &Path, grid: &GridSpec<'_>) -> std::io::Result<()> {
    let (corners, kind, connectivity): (usize, u8, &[u32]) = match grid.cells {
        Cells::Hexahedra(cells) => (8, 12, cells.as_flattened()),
        Cells::Quads(cells) => (4, 9, cells.as_flattened()),
    };
    let cells = connectivity.len() / corners;
    let mut body = Appended::default();
    let mut header = String::from("<?xml version=\"1.0\"?>\n");
    header += XML_MARK;
    header += "\n";
    header.push_str(
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" \
         byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n",
    );
    header += &format!(
        "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{cells}\">\n<Points>\n",
        grid.points.len()
    );
    let doubles = |v: &[f64]| v.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
    header += &body.array("Points", "Float64", 3, doubles(grid.points.as_flattened()));
    header += "</Points>\n<Cells>\n";
    let bytes = connectivity.iter().flat_map(|&n| i64::from(n).to_le_bytes()).collect();
    header += &body.array("connectivity", "Int64", 1, bytes);
    let bytes = (1..=cells).flat_map(|k| ((k * corners) as i64).to_le_bytes()).collect();
    header += &body.array("offsets", "Int64", 1, bytes);
    header += &body.array("types", "UInt8", 1, vec![kind; cells]);
    header += "</Cells>\n";
    for (tag, on_cells) in [("PointData", false), ("CellData", true)] {
        header += &format!("<{tag}>\n");
        for field in grid.constant.iter().filter(|f| f.spec.on_cells == on_cells) {
            let (kind, bytes) = match field.values {
                Values::Scalar(v) => ("Float64", doubles(v)),
                Values::Vector(v) => ("Float64", doubles(v.as_flattened())),
                Values::Tensor(v) => ("Float64", doubles(v.as_flattened())),
                Values::Integer(v) => ("UInt8", v.to_vec()),
            };
            header += &body.array(&field.spec.name, kind, field.spec.components, bytes);
        }
        header += &format!("</{tag}>\n");
    }
    header += "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
    let mut out = BufWriter::new(File::create(path)?);
    out.write_all(header.as_bytes())?;
    out.write_all(&body.bytes)?;
    out.write_all(b"\n</AppendedData>\n</VTKFile>\n")?;
    out.flush()
}

/// The binary part: each array behind its length.
#[derive(Default)]
struct Appended {
    bytes: Vec<u8>,
}

impl Appended {
    /// Appends an array and returns the XML element that refers to it.
    fn array(&mut self, name: &str, kind: &str, components: usize, data: Vec<u8>) -> String {
        let offset = self.bytes.len();
        self.bytes.extend((data.len() as u64).to_le_bytes());
        self.bytes.extend(data);
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" \
             format=\"appended\" offset=\"{offset}\"/>\n"
        )
    }
}
