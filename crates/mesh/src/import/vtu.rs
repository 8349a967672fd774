//! VTK XML unstructured grids (`.vtu`).
//!
//! Source: "VTK File Formats" and "VTK XML Formats", docs.vtk.org. Arrays may be text, base64 or raw, inline or
//! appended, compressed by zlib or not. A set is an array of zeros and ones, or one of the sets that meshio puts into
//! one array: over the points it holds nodes; over the cells, hexahedra and quadrangles. An array `body` over the cells
//! says which belong to the disk (0) and to the bar (1), as in Creepage's own files.
//!
//! Libraries read XML, base64 and zlib (`roxmltree`, `base64`, `miniz_oxide`). `vtkio` 0.7.0-rc2 is not used: it does
//! not read raw appended data, and its errors name neither the line nor the array.

use super::error::{Fault, ImportError};
use super::foreign::Foreign;
use super::nesting::{DEEPEST, too_deep};
use super::set_arrays::{Cell, SetArray, SetsOfArrays};
use super::text::{decoded, number};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use nalgebra::Vector3;
use roxmltree::{Document, Node};

/// Most bytes of an array that one byte of zlib data can stand for.
const ZLIB_RATIO: usize = 1100;

/// Most arrays over points, or over cells, that a file may have.
const MOST_ARRAYS: usize = 200;

/// Reads a VTU file. Vertices and lines are ignored; arrays of more than one component are no sets.
///
/// # Errors
/// [`Fault::Syntax`] or [`Fault::Unknown`] for a file that does not follow the format, [`Fault::Cell`] for cells
/// other than hexahedra with 8 nodes, quadrangles, vertices and lines, and [`Fault::Unsupported`] for grids in
/// several pieces and for compressors other than zlib.
pub fn read_vtu(bytes: &[u8]) -> Result<Foreign, ImportError> {
    let (head, appended) = split(bytes);
    let mut head = decoded(head)?;
    if appended.is_some() {
        head += "</VTKFile>";
    }
    if let Some(line) = too_deep(&head) {
        let what = format!("elements of the file lie more than {DEEPEST} deep in one another");
        return Err(Fault::Syntax { what }.at(line));
    }
    let document = Document::parse(&head).map_err(|error| {
        Fault::Syntax { what: format!("the file is no well-formed XML: {error}") }
            .at(error.pos().row as usize)
    })?;
    let root = document.root_element();
    let file = File::new(root, appended)?;
    let grid = child(root, "UnstructuredGrid").ok_or_else(|| {
        let what = format!("a file of the type {}", root.attribute("type").unwrap_or("unknown"));
        unsupported(root, &what, "write an unstructured grid (.vtu)")
    })?;
    let mut pieces = grid.children().filter(|node| node.has_tag_name("Piece"));
    let (Some(piece), None) = (pieces.next(), pieces.next()) else {
        let remedy = "write the grid in one piece";
        return Err(unsupported(grid, "a grid in several pieces, or in none,", remedy));
    };
    file.piece(piece)
}

/// Cuts the file where the section of appended data begins: the XML before it, and the section, which need not be
/// text.
fn split(bytes: &[u8]) -> (&[u8], Option<&[u8]>) {
    const START: &[u8] = b"<AppendedData";
    match bytes.windows(START.len()).position(|window| window == START) {
        Some(at) => (&bytes[..at], Some(&bytes[at..])),
        None => (bytes, None),
    }
}

fn child<'a, 'i>(node: Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|child| child.has_tag_name(name))
}

fn line(node: Node) -> usize {
    node.document().text_pos_at(node.range().start).row as usize
}

fn syntax(node: Node, what: impl Into<String>) -> ImportError {
    Fault::Syntax { what: what.into() }.at(line(node))
}

fn unsupported(node: Node, what: &str, remedy: &'static str) -> ImportError {
    Fault::Unsupported { what: what.into(), remedy }.at(line(node))
}

/// How the arrays of a file are encoded.
struct File<'a> {
    big_endian: bool,
    /// Bytes of a number in the header of an array, 4 or 8.
    word: usize,
    zlib: bool,
    /// Appended data after their initial `_`, and whether they are base64.
    appended: Option<(&'a [u8], bool)>,
}

/// The numbers of an array: real or whole.
enum Numbers {
    Real(Vec<f64>),
    Whole(Vec<i64>),
}

impl<'a> File<'a> {
    fn new(root: Node, appended: Option<&'a [u8]>) -> Result<Self, ImportError> {
        let zlib = match root.attribute("compressor") {
            None => false,
            Some("vtkZLibDataCompressor") => true,
            Some(other) => {
                let remedy = "write it with zlib or without compression";
                return Err(unsupported(root, &format!("the compressor {other}"), remedy));
            }
        };
        let word = if root.attribute("header_type") == Some("UInt64") { 8 } else { 4 };
        let big_endian = root.attribute("byte_order") == Some("BigEndian");
        let appended = match appended {
            None => None,
            Some(section) => {
                let end = section.iter().position(|&b| b == b'>');
                let (tag, data) = section.split_at(end.unwrap_or(section.len()));
                let mark = data.iter().position(|&b| b == b'_');
                let Some(mark) = mark else {
                    return Err(syntax(root, "the appended data do not begin with _"));
                };
                let raw = tag.windows(5).any(|w| w == b"\"raw\"" || w == b"'raw'");
                Some((&data[mark + 1..], !raw))
            }
        };
        Ok(Self { big_endian, word, zlib, appended })
    }

    fn piece(&self, piece: Node) -> Result<Foreign, ImportError> {
        let part = |name: &str| {
            child(piece, name).ok_or_else(|| syntax(piece, format!("the piece has no {name}")))
        };
        let cells = part("Cells")?;
        let cell = |name: &str| {
            let array = arrays(cells).find(|a| a.attribute("Name") == Some(name));
            let array = array.ok_or_else(|| syntax(cells, format!("Cells have no {name}")))?;
            Ok(self.numbers(array)?.whole())
        };
        let points = part("Points")?;
        let points = arrays(points).next().ok_or_else(|| syntax(points, "Points have no array"))?;
        let coordinates = self.numbers(points)?.real();
        let (triples, rest) = coordinates.as_chunks::<3>();
        if !rest.is_empty() {
            return Err(syntax(points, "points have three coordinates each"));
        }
        let mut foreign = Foreign {
            points: triples.iter().copied().map(Vector3::from).collect(),
            ..Foreign::default()
        };
        let [connectivity, offsets, types]: [Vec<i64>; 3] =
            [cell("connectivity")?, cell("offsets")?, cell("types")?];
        if offsets.len() != types.len() {
            return Err(syntax(cells, "there are as many offsets as types of cells"));
        }
        let mut members = Vec::with_capacity(types.len());
        let mut start = 0;
        for (i, (&end, &kind)) in offsets.iter().zip(&types).enumerate() {
            let nodes = usize::try_from(end).ok().and_then(|end| connectivity.get(start..end));
            let nodes = nodes
                .ok_or_else(|| syntax(cells, format!("cell {i} ends outside the connectivity")))?;
            start += nodes.len();
            let member =
                self.cell(i as u64, kind, nodes, foreign.points.len(), foreign.hexes.len());
            let member = member.map_err(|fault| fault.at(line(cells)))?;
            if let Cell::Hex(_, nodes) = member {
                foreign.elements.ids.push(i as u64);
                foreign.hexes.push(nodes);
            }
            members.push(member);
        }
        self.sets(piece, &mut foreign, &members)?;
        Ok(foreign)
    }

    /// A cell by its VTK type `kind` and its nodes, of which there are `points`; `hex` is the index that it has as a
    /// hexahedron.
    fn cell(
        &self,
        element: u64,
        kind: i64,
        nodes: &[i64],
        points: usize,
        hex: usize,
    ) -> Result<Cell, Fault> {
        let kind = match (kind, nodes.len()) {
            (12, 8) => {
                let mut corners = [0; 8];
                checked(element, nodes, points, &mut corners)?;
                return Ok(Cell::Hex(hex as u32, corners));
            }
            (9, 4) => {
                let mut corners = [0; 4];
                checked(element, nodes, points, &mut corners)?;
                return Ok(Cell::Quad(corners));
            }
            (1..=4, _) => return Ok(Cell::Ignored),
            (5 | 22, _) => "a triangle",
            (8 | 11, _) => "a pixel or voxel",
            (10 | 24, _) => "a tetrahedron",
            (13 | 26, _) => "a wedge",
            (14 | 27, _) => "a pyramid",
            (21, _) => "a line of second order",
            (23 | 28, _) => "a quadrangle of second order",
            (25, _) => "a hexahedron with 20 nodes",
            (29, _) => "a hexahedron with 27 nodes",
            _ => "of another shape or number of nodes",
        };
        Err(Fault::Cell { element, kind: kind.into() })
    }

    /// Makes sets of the arrays that hold sets.
    fn sets(
        &self,
        piece: Node,
        foreign: &mut Foreign,
        members: &[Cell],
    ) -> Result<(), ImportError> {
        let mut sets = SetsOfArrays::default();
        for (section, cells) in [("PointData", None), ("CellData", Some(members))] {
            let count = cells.map_or(foreign.points.len(), <[Cell]>::len);
            let all: Vec<Node> = child(piece, section).into_iter().flat_map(arrays).collect();
            if all.len() > MOST_ARRAYS {
                let what = format!("a grid with {} arrays in {section}", all.len());
                return Err(unsupported(piece, &what, "write the sets alone"));
            }
            for array in all {
                let components = array.attribute("NumberOfComponents").unwrap_or("1");
                let Some(name) = array.attribute("Name").filter(|_| components == "1") else {
                    continue;
                };
                let kind = array.attribute("type").unwrap_or_default();
                if kind == "String" {
                    continue;
                }
                let values = self.numbers(array)?.whole();
                if values.len() != count {
                    return Err(syntax(
                        array,
                        format!("{name} has {} values, not {count}", values.len()),
                    ));
                }
                let wide = matches!(kind, "Int32" | "Int64");
                sets.take(&SetArray { name, values: &values, wide, cells });
            }
        }
        foreign.notes.append(&mut sets.notes);
        foreign.sets = sets.sets();
        Ok(())
    }

    fn numbers(&self, array: Node) -> Result<Numbers, ImportError> {
        let kind = array.attribute("type").unwrap_or("unknown");
        let Some(width) = width(kind) else {
            let remedy = "write numbers as Float32, Float64 or Int8 to UInt64";
            return Err(unsupported(array, &format!("an array of the type {kind}"), remedy));
        };
        let text = array.text().unwrap_or_default();
        let bytes = match array.attribute("format") {
            Some("ascii") => {
                let real = kind.starts_with("Float");
                let words = text.split_whitespace();
                let at = |fault: Fault| fault.at(line(array));
                return Ok(if real {
                    let read = words.map(|w| number(w, "a number")).collect::<Result<_, _>>();
                    Numbers::Real(read.map_err(at)?)
                } else {
                    let read = words.map(|w| number(w, "a whole number")).collect::<Result<_, _>>();
                    Numbers::Whole(read.map_err(at)?)
                });
            }
            Some("binary") => {
                // an empty array may lack its header too
                if text.trim().is_empty() {
                    Vec::new()
                } else {
                    self.unpack(array, Packed::Base64(text.as_bytes()))?
                }
            }
            Some("appended") => {
                let offset = array.attribute("offset").and_then(|o| o.trim().parse::<usize>().ok());
                let (data, base64) = self.appended.ok_or_else(|| {
                    syntax(array, "an array is appended, but the file has no AppendedData")
                })?;
                let data = offset.and_then(|offset| data.get(offset..));
                let data = data
                    .ok_or_else(|| syntax(array, "the offset of an array is outside the data"))?;
                self.unpack(array, if base64 { Packed::Base64(data) } else { Packed::Raw(data) })?
            }
            other => {
                let other = other.unwrap_or("unknown");
                return Err(syntax(array, format!("an array of the format {other}")));
            }
        };
        if !bytes.len().is_multiple_of(width) {
            return Err(syntax(array, "the bytes of an array are no whole numbers of its type"));
        }
        let words = bytes.chunks_exact(width).map(|word| {
            let mut padded = [0u8; 8];
            padded[..width].copy_from_slice(word);
            if self.big_endian {
                padded[..width].reverse();
            }
            u64::from_le_bytes(padded)
        });
        let signed = kind.starts_with("Int");
        let shift = 64 - 8 * width as u32;
        Ok(match kind {
            "Float64" => Numbers::Real(words.map(f64::from_bits).collect()),
            "Float32" => {
                Numbers::Real(words.map(|w| f64::from(f32::from_bits(w as u32))).collect())
            }
            _ if signed => Numbers::Whole(words.map(|w| (w << shift) as i64 >> shift).collect()),
            _ => Numbers::Whole(words.map(|w| i64::try_from(w).unwrap_or(i64::MAX)).collect()),
        })
    }

    /// The decoded bytes of an array.
    ///
    /// Uncompressed, a header with the number of bytes precedes them. Compressed, a header with the number of
    /// blocks, the size of a block, that of the last block and the compressed size of each precedes the blocks.
    /// In base64 the header of compressed data is encoded by itself; that of others may be, and then ends with the
    /// sign `=`, or is encoded with its data.
    fn unpack(&self, array: Node, packed: Packed) -> Result<Vec<u8>, ImportError> {
        let cut_short = || syntax(array, "an array ends before its header says");
        let word = |bytes: &[u8], i: usize| {
            let bytes = bytes.get(i * self.word..(i + 1) * self.word)?;
            let mut padded = [0u8; 8];
            padded[..self.word].copy_from_slice(bytes);
            if self.big_endian {
                padded[..self.word].reverse();
            }
            usize::try_from(u64::from_le_bytes(padded)).ok()
        };
        let start = packed.header(self.word, array)?;
        let first = word(&start, 0).ok_or_else(cut_short)?;
        if first == 0 {
            return Ok(Vec::new());
        }
        if !self.zlib {
            let apart = start.len() == self.word;
            let bytes = if apart {
                packed.part(self.word, first, array)?
            } else {
                let end = self.word.checked_add(first).ok_or_else(cut_short)?;
                packed.part(0, end, array)?.split_off(self.word)
            };
            return if bytes.len() < first { Err(cut_short()) } else { Ok(bytes) };
        }
        let words = first.checked_add(3).ok_or_else(cut_short)?;
        let header = words.checked_mul(self.word).ok_or_else(cut_short)?;
        let header = packed.part(0, header, array)?;
        if header.len() < words * self.word {
            return Err(cut_short());
        }
        let (block, last) =
            (word(&header, 1).ok_or_else(cut_short)?, word(&header, 2).ok_or_else(cut_short)?);
        let mut sizes = Vec::new();
        for i in 0..first {
            sizes.push(word(&header, 3 + i).ok_or_else(cut_short)?);
        }
        let total = sizes.iter().try_fold(0usize, |sum, size| sum.checked_add(*size));
        let total = total.ok_or_else(cut_short)?;
        let body = packed.part(header.len(), total, array)?;
        let (mut bytes, mut at) = (Vec::new(), 0);
        for (i, &size) in sizes.iter().enumerate() {
            let block = if i + 1 == sizes.len() && last > 0 { last } else { block };
            let packed = body.get(at..at + size).ok_or_else(cut_short)?;
            at += size;
            if block > ZLIB_RATIO.saturating_mul(size.max(1)) {
                return Err(cut_short());
            }
            let unpacked = miniz_oxide::inflate::decompress_to_vec_zlib_with_limit(packed, block);
            let unpacked =
                unpacked.map_err(|_| syntax(array, "the zlib data of an array are damaged"))?;
            if unpacked.len() != block {
                return Err(cut_short());
            }
            bytes.extend(unpacked);
        }
        Ok(bytes)
    }
}

/// Encoded bytes of an array, possibly with more of the file after them.
#[derive(Clone, Copy)]
enum Packed<'a> {
    Raw(&'a [u8]),
    Base64(&'a [u8]),
}

impl Packed<'_> {
    /// The bytes of a header of `count` bytes, and of what is encoded with its last.
    fn header(&self, count: usize, array: Node) -> Result<Vec<u8>, ImportError> {
        match self {
            Self::Raw(_) => self.part(0, count, array),
            Self::Base64(data) => decode(data, 0, characters(count), array),
        }
    }

    /// `count` decoded bytes, or all if there are fewer, after a header of `header` bytes that is encoded by itself.
    fn part(&self, header: usize, count: usize, array: Node) -> Result<Vec<u8>, ImportError> {
        match self {
            Self::Raw(data) => {
                let data = data.get(header..).unwrap_or_default();
                Ok(data[..count.min(data.len())].to_vec())
            }
            Self::Base64(data) => {
                let mut bytes = decode(data, characters(header), characters(count), array)?;
                bytes.truncate(count);
                Ok(bytes)
            }
        }
    }
}

/// How many characters of base64 so many bytes have.
fn characters(bytes: usize) -> usize {
    bytes.div_ceil(3).saturating_mul(4)
}

/// Decodes so many characters of base64 after the first `skipped`; blanks and line ends do not count.
fn decode(
    data: &[u8],
    skipped: usize,
    characters: usize,
    array: Node,
) -> Result<Vec<u8>, ImportError> {
    let data = data.iter().filter(|byte| !byte.is_ascii_whitespace());
    let data: Vec<u8> = data.skip(skipped).take(characters).copied().collect();
    STANDARD.decode(data).map_err(|_| syntax(array, "the base64 data of an array are damaged"))
}

fn arrays<'a, 'i: 'a>(node: Node<'a, 'i>) -> impl Iterator<Item = Node<'a, 'i>> {
    node.children().filter(|child| child.has_tag_name("DataArray"))
}

/// Size of a number of a VTK type (bytes); `None` for a type that is not read.
fn width(kind: &str) -> Option<usize> {
    match kind {
        "Int8" | "UInt8" => Some(1),
        "Int16" | "UInt16" => Some(2),
        "Int32" | "UInt32" | "Float32" => Some(4),
        "Int64" | "UInt64" | "Float64" => Some(8),
        _ => None,
    }
}

impl Numbers {
    fn real(self) -> Vec<f64> {
        match self {
            Self::Real(values) => values,
            Self::Whole(values) => values.into_iter().map(|v| v as f64).collect(),
        }
    }

    /// The numbers as integers; -1 in place of one that is none.
    fn whole(self) -> Vec<i64> {
        match self {
            Self::Whole(values) => values,
            Self::Real(values) => {
                values.into_iter().map(|v| if v.fract() == 0.0 { v as i64 } else { -1 }).collect()
            }
        }
    }
}

/// Copies the nodes of a cell into `to`; each must be one of the `points` nodes of the grid.
fn checked(element: u64, nodes: &[i64], points: usize, to: &mut [u32]) -> Result<(), Fault> {
    for (to, &node) in to.iter_mut().zip(nodes) {
        let place = usize::try_from(node).ok().filter(|&n| n < points);
        let place = place.and_then(|n| u32::try_from(n).ok());
        *to = place.ok_or_else(|| {
            let from = format!("element {element}");
            Fault::Unknown { from, what: format!("node {node}") }
        })?;
    }
    Ok(())
}
