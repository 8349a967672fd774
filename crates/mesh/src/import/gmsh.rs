//! Gmsh's MSH files, formats 2.2 and 4.1, as text.
//!
//! Source: Gmsh reference manual, "MSH file format" and "MSH file format version 2 (legacy)".
//! Physical groups become sets: volumes of hexahedra give elements, surfaces of quadrangles faces, and lines and
//! points their nodes.
//!
//! The library `mshio` is not used: it reads neither version 2.2 nor the names of physical groups.

use super::error::{Fault, ImportError};
use super::foreign::Foreign;
use super::text::Text;
use std::collections::{BTreeMap, HashMap};

/// Most physical groups that one entity may belong to.
const MOST_GROUPS: u64 = 100;

/// Reads an MSH file of format 2.2 or 4.1, saved as text.
///
/// # Errors
/// [`Fault::Syntax`], [`Fault::Repeated`] or [`Fault::Unknown`] for a file that does not follow the format,
/// [`Fault::Cell`] for cells other than hexahedra with 8 nodes, points, lines and quadrangles, and
/// [`Fault::Unsupported`] for binary files and other versions.
pub fn read_gmsh(bytes: &[u8]) -> Result<Foreign, ImportError> {
    // A binary file says so in its first lines, which are text.
    let head = &bytes[..bytes.len().min(200)];
    let mut lines = head.split(|&b| b == b'\n');
    let binary = lines.next().is_some_and(|l| l.trim_ascii() == b"$MeshFormat")
        && lines
            .next()
            .and_then(|l| str::from_utf8(l).ok())
            .is_some_and(|l| l.split_whitespace().nth(1) == Some("1"));
    if binary {
        let what = "a binary MSH file".into();
        let remedy = "save it as text: Mesh.Binary = 0 in Gmsh, binary=False in meshio";
        return Err(Fault::Unsupported { what, remedy }.at(2));
    }
    let mut reader = Reader { text: Text::new(bytes)?, ..Reader::default() };
    reader.sections()?;
    Ok(reader.foreign)
}

/// The beginning of an MSH file that this program wrote.
pub const GMSH_MARK: &str =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Comments\nCreepage\n$EndComments\n";

/// A mesh as the text of an MSH file of format 2.2. Reading it again gives the same coordinates to the last bit.
///
/// The sets become physical groups: elements volumes, faces surfaces of quadrangles, nodes points. Nodes, and elements of
/// all kinds together, are numbered from 1. A hexahedron stands once for each set that it belongs to; one in no set is left
/// out.
pub fn write_gmsh(mesh: &Foreign) -> String {
    let mut text = String::from(GMSH_MARK);
    let mut names = Vec::new();
    let mut elements = Vec::new();
    let row = |corners: &[u32]| corners.iter().map(|n| format!(" {}", n + 1)).collect::<String>();
    let mut id = mesh.hexes.len();
    for (group, (name, set)) in (1..).zip(&mesh.sets) {
        let (faces, nodes) = (&set.faces, &set.nodes);
        let kinds = [(3, set.hexes.len()), (2, faces.len()), (0, nodes.len())];
        let given = kinds.iter().filter(|(_, members)| *members > 0);
        names.extend(given.map(|(dimension, _)| format!("{dimension} {group} \"{name}\"\n")));
        for &hex in &set.hexes {
            let corners = row(&mesh.hexes[hex as usize]);
            elements.push(format!("{} 5 2 {group} {group}{corners}\n", hex + 1));
        }
        for (kind, corners) in faces
            .iter()
            .map(|face| (3, face.as_slice()))
            .chain(nodes.iter().map(|node| (15, std::slice::from_ref(node))))
        {
            id += 1;
            elements.push(format!("{id} {kind} 2 {group} {group}{}\n", row(corners)));
        }
    }
    text += &format!("$PhysicalNames\n{}\n{}$EndPhysicalNames\n", names.len(), names.concat());
    text += &format!("$Nodes\n{}\n", mesh.points.len());
    for (n, [x, y, z]) in (1..).zip(&mesh.points) {
        text += &format!("{n} {x:?} {y:?} {z:?}\n");
    }
    text + &format!("$EndNodes\n$Elements\n{}\n{}$EndElements\n", elements.len(), elements.concat())
}

#[derive(Default)]
struct Reader<'a> {
    text: Text<'a>,
    foreign: Foreign,
    /// Names of physical groups by dimension and number.
    names: BTreeMap<(u8, i64), String>,
    /// Physical groups of the entities of format 4.1, by dimension and number.
    groups: HashMap<(u8, i64), Vec<i64>>,
    /// Indices of nodes by their numbers.
    indices: HashMap<u64, u32>,
    /// Indices of hexahedra by their numbers.
    hexes: HashMap<u64, u32>,
}

/// Dimension and number of nodes of an element type that is read; for any other, what it is.
fn kind(number: i64) -> Result<(u8, usize), &'static str> {
    match number {
        15 => Ok((0, 1)),
        1 => Ok((1, 2)),
        3 => Ok((2, 4)),
        5 => Ok((3, 8)),
        2 => Err("a triangle"),
        4 => Err("a tetrahedron"),
        6 => Err("a prism"),
        7 => Err("a pyramid"),
        8 => Err("a line of second order"),
        9 => Err("a triangle of second order"),
        10 | 16 => Err("a quadrangle of second order"),
        11 => Err("a tetrahedron of second order"),
        12 => Err("a hexahedron with 27 nodes"),
        13 | 18 => Err("a prism of second order"),
        14 | 19 => Err("a pyramid of second order"),
        17 => Err("a hexahedron with 20 nodes"),
        _ => Err("of a higher order or of another shape"),
    }
}

impl<'a> Reader<'a> {
    fn sections(&mut self) -> Result<(), ImportError> {
        let mut version = None;
        while let Some(line) = self.text.next_line() {
            let Some(section) = line.strip_prefix('$') else {
                if line.is_empty() {
                    continue;
                }
                return Err(self.syntax("a section that starts with $ is expected"));
            };
            match (section, version) {
                ("MeshFormat", _) => version = Some(self.format()?),
                ("PhysicalNames", Some(_)) => self.physical_names()?,
                ("Entities", Some(4)) => self.entities()?,
                ("Nodes", Some(2)) => self.nodes_2()?,
                ("Nodes", Some(_)) => self.nodes_4()?,
                ("Elements", Some(2)) => self.elements_2()?,
                ("Elements", Some(_)) => self.elements_4()?,
                (_, Some(_)) => {
                    self.skip(section)?;
                    continue;
                }
                (_, None) => return Err(self.syntax("$MeshFormat is expected first")),
            }
            let end = format!("$End{section}");
            match self.text.word() {
                Some(word) if word == end => {}
                Some(_) => return Err(self.syntax(&format!("{end} is expected"))),
                None => return Err(self.text.ends(&end)),
            }
        }
        match version {
            Some(_) => Ok(()),
            None => Err(self.syntax("the file holds no $MeshFormat")),
        }
    }

    fn syntax(&self, what: &str) -> ImportError {
        Fault::Syntax { what: what.into() }.at(self.text.line)
    }

    fn skip(&mut self, section: &str) -> Result<(), ImportError> {
        let end = format!("$End{section}");
        while let Some(line) = self.text.next_line() {
            if line == end {
                return Ok(());
            }
        }
        Err(self.text.ends(&end))
    }

    /// The major version of the format, 2 or 4.
    fn format(&mut self) -> Result<u8, ImportError> {
        let version = self.text.word().unwrap_or_default();
        let main = match version {
            "2" | "2.0" | "2.1" | "2.2" => 2,
            "4.1" => 4,
            _ => {
                let what = format!("MSH format {version}");
                let remedy = "save it in format 4.1 or 2.2: Mesh.MshFileVersion in Gmsh";
                return Err(Fault::Unsupported { what, remedy }.at(self.text.line));
            }
        };
        let _binary: u8 = self.text.number("the type of the file")?;
        let _size: u8 = self.text.number("the size of a number")?;
        Ok(main)
    }

    fn physical_names(&mut self) -> Result<(), ImportError> {
        let count: u64 = self.text.number("the number of names")?;
        for _ in 0..count {
            let line = self.text.next_line().ok_or_else(|| self.text.ends("a physical name"))?;
            let word = |text: &'a str| text.trim_start().split_once(char::is_whitespace);
            let (dimension, rest) = word(line).unwrap_or_default();
            let (number, name) = word(rest).unwrap_or_default();
            let name = name.trim().trim_matches('"');
            let (Ok(dimension), Ok(number)) = (dimension.parse(), number.parse()) else {
                return Err(self.syntax("a dimension, a number and a name in quotes are expected"));
            };
            self.names.insert((dimension, number), name.to_owned());
        }
        Ok(())
    }

    /// Reads which physical groups the entities belong to.
    fn entities(&mut self) -> Result<(), ImportError> {
        let text = &mut self.text;
        let mut counts = [0u64; 4];
        for count in &mut counts {
            *count = text.number("the number of entities")?;
        }
        for (dimension, count) in (0u8..).zip(counts) {
            for _ in 0..count {
                let tag: i64 = text.number("the number of an entity")?;
                for _ in 0..if dimension == 0 { 3 } else { 6 } {
                    let _bound: f64 = text.number("a bound of an entity")?;
                }
                let groups: u64 = text.number("the number of physical groups")?;
                if groups > MOST_GROUPS {
                    let what = format!("an entity of {groups} physical groups");
                    let remedy = "put each entity into a few physical groups at most";
                    return Err(Fault::Unsupported { what, remedy }.at(text.line));
                }
                for _ in 0..groups {
                    let group: i64 = text.number("a physical group")?;
                    self.groups.entry((dimension, tag)).or_default().push(group.abs());
                }
                if dimension > 0 {
                    let parts: u64 = text.number("the number of bounding entities")?;
                    for _ in 0..parts {
                        let _part: i64 = text.number("a bounding entity")?;
                    }
                }
            }
        }
        Ok(())
    }

    fn node(&mut self, id: u64, line: usize, point: [f64; 3]) -> Result<(), ImportError> {
        if self.indices.insert(id, self.foreign.points.len() as u32).is_some() {
            return Err(Fault::Repeated { what: "node", id }.at(line));
        }
        self.foreign.points.push(point);
        self.foreign.nodes.push(id, line);
        Ok(())
    }

    fn nodes_2(&mut self) -> Result<(), ImportError> {
        let count: u64 = self.text.number("the number of nodes")?;
        for _ in 0..count {
            let id = self.text.number("the number of a node")?;
            let line = self.text.line;
            let point = self.point()?;
            self.node(id, line, point)?;
        }
        Ok(())
    }

    fn point(&mut self) -> Result<[f64; 3], ImportError> {
        let mut point = [0.0; 3];
        for x in &mut point {
            *x = self.text.number("a coordinate")?;
        }
        Ok(point)
    }

    fn nodes_4(&mut self) -> Result<(), ImportError> {
        let blocks: u64 = self.text.number("the number of blocks")?;
        for what in ["the number of nodes", "the least number", "the largest number"] {
            let _: u64 = self.text.number(what)?;
        }
        for _ in 0..blocks {
            let dimension: u8 = self.text.number("the dimension of an entity")?;
            let _entity: i64 = self.text.number("the number of an entity")?;
            let parametric: u8 = self.text.number("whether coordinates are parametric")?;
            let count: u64 = self.text.number("the number of nodes")?;
            let mut ids = Vec::new();
            for _ in 0..count {
                ids.push(self.text.number("the number of a node")?);
            }
            for id in ids {
                let point = self.point()?;
                let line = self.text.line;
                for _ in 0..if parametric == 1 { dimension } else { 0 } {
                    let _: f64 = self.text.number("a parametric coordinate")?;
                }
                self.node(id, line, point)?;
            }
        }
        Ok(())
    }

    fn elements_2(&mut self) -> Result<(), ImportError> {
        let count: u64 = self.text.number("the number of elements")?;
        for _ in 0..count {
            let id = self.text.number("the number of an element")?;
            let line = self.text.line;
            let kind = self.text.number("the type of an element")?;
            let tags: u64 = self.text.number("the number of tags")?;
            let mut group = 0;
            for i in 0..tags {
                let tag: i64 = self.text.number("a tag")?;
                if i == 0 {
                    group = tag.abs();
                }
            }
            self.element(id, line, kind, &[group])?;
        }
        Ok(())
    }

    fn elements_4(&mut self) -> Result<(), ImportError> {
        let blocks: u64 = self.text.number("the number of blocks")?;
        for what in ["the number of elements", "the least number", "the largest number"] {
            let _: u64 = self.text.number(what)?;
        }
        for _ in 0..blocks {
            let dimension: u8 = self.text.number("the dimension of an entity")?;
            let entity: i64 = self.text.number("the number of an entity")?;
            let kind = self.text.number("the type of an element")?;
            let count: u64 = self.text.number("the number of elements")?;
            let groups = self.groups.get(&(dimension, entity)).cloned().unwrap_or_default();
            for _ in 0..count {
                let id = self.text.number("the number of an element")?;
                let line = self.text.line;
                self.element(id, line, kind, &groups)?;
            }
        }
        Ok(())
    }

    /// Reads the nodes of an element, and adds it to the sets of its groups.
    fn element(
        &mut self,
        id: u64,
        line: usize,
        number: i64,
        groups: &[i64],
    ) -> Result<(), ImportError> {
        let (dimension, size) =
            kind(number).map_err(|kind| Fault::Cell { element: id, kind: kind.into() }.at(line))?;
        let mut nodes = [0u32; 8];
        for node in &mut nodes[..size] {
            let name: u64 = self.text.number("a node of an element")?;
            *node = *self.indices.get(&name).ok_or_else(|| {
                let from = format!("element {id}");
                Fault::Unknown { from, what: format!("node {name}") }.at(self.text.line)
            })?;
        }
        let next = self.foreign.hexes.len() as u32;
        let hex = if dimension == 3 { *self.hexes.entry(id).or_insert(next) } else { next };
        if dimension == 3 && hex == next {
            self.foreign.hexes.push(nodes);
            self.foreign.elements.push(id, line);
        } else if dimension == 3 && self.foreign.hexes[hex as usize] != nodes {
            // format 2.2 repeats an element for each group that it belongs to
            return Err(Fault::Repeated { what: "element", id }.at(line));
        }
        for &group in groups.iter().filter(|&&group| group != 0) {
            let name = self.names.get(&(dimension, group)).cloned();
            let set = self.foreign.set(&name.unwrap_or_else(|| group.to_string()));
            match dimension {
                3 => set.hexes.push(hex),
                2 => set.faces.push([nodes[0], nodes[1], nodes[2], nodes[3]]),
                _ => set.nodes.extend(&nodes[..size]),
            }
        }
        Ok(())
    }
}
