//! Gmsh's MSH files, formats 2.2 and 4.1, as text or binary.
//!
//! Source: Gmsh reference manual, "MSH file format" and "MSH file format version 2 (legacy)".
//! Physical groups become sets: volumes of hexahedra give elements, surfaces of quadrangles faces, and lines and
//! points their nodes.
//!
//! The library `mshio` 0.4.2 is not used: it reads neither version 2.2 nor the names of physical groups.

mod values;
mod write;

pub use write::{GMSH_MARK, write_gmsh};

use super::error::{Fault, ImportError, Place};
use super::foreign::Foreign;
use super::text::decoded;
use nalgebra::Vector3;
use std::collections::{BTreeMap, HashMap};
use values::{Values, is_binary};

/// Most physical groups that one entity may belong to.
const MOST_GROUPS: u64 = 100;

/// Reads an MSH file of format 2.2 or 4.1.
///
/// # Errors
/// [`Fault::Syntax`], [`Fault::Repeated`] or [`Fault::Unknown`] for a file that does not follow the format,
/// [`Fault::Cell`] for cells other than hexahedra with 8 nodes, points, lines and quadrangles, and
/// [`Fault::Unsupported`] for other versions.
pub fn read_gmsh(bytes: &[u8]) -> Result<Foreign, ImportError> {
    let text = if is_binary(bytes) { None } else { Some(decoded(bytes)?) };
    let mut reader = Reader {
        values: text.as_deref().map_or_else(|| Values::binary(bytes), Values::text),
        version: 0,
        foreign: Foreign::default(),
        names: BTreeMap::new(),
        groups: HashMap::new(),
        indices: HashMap::new(),
        hexes: HashMap::new(),
    };
    reader.sections()?;
    Ok(reader.foreign)
}

struct Reader<'a> {
    values: Values<'a>,
    /// Major version of the format, 2 or 4; 0 before it is known.
    version: u8,
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

impl Reader<'_> {
    fn sections(&mut self) -> Result<(), ImportError> {
        while let Some(line) = self.values.next_line()? {
            let Some(section) = line.strip_prefix('$') else {
                if line.is_empty() {
                    continue;
                }
                return Err(self.values.syntax("a section that starts with $ is expected"));
            };
            let end = format!("$End{section}");
            match (section, self.version) {
                ("MeshFormat", _) => self.format()?,
                (_, 0) => return Err(self.values.syntax("$MeshFormat is expected first")),
                ("PhysicalNames", _) => self.physical_names()?,
                ("Entities", 4) => self.entities()?,
                ("Nodes", 2) => self.nodes_2()?,
                ("Nodes", _) => self.nodes_4()?,
                ("Elements", 2) => self.elements_2()?,
                ("Elements", _) => self.elements_4()?,
                _ => {
                    self.values.skip(&end)?;
                    continue;
                }
            }
            match self.values.word()? {
                Some(word) if word == end => {}
                Some(_) => return Err(self.values.syntax(&format!("{end} is expected"))),
                None => return Err(self.values.ends(&end)),
            }
        }
        match self.version {
            0 => Err(self.values.syntax("the file holds no $MeshFormat")),
            _ => Ok(()),
        }
    }

    /// Takes the version of the format.
    fn format(&mut self) -> Result<(), ImportError> {
        let line = self.values.next_line()?.unwrap_or_default();
        let words: Vec<&str> = line.split_whitespace().collect();
        let place = self.values.place();
        let unsupported = |what, remedy| Err(Fault::Unsupported { what, remedy }.at(place));
        self.version = match words[..] {
            ["2" | "2.0" | "2.1" | "2.2", ..] => 2,
            ["4.1", ..] => 4,
            _ => {
                let what = format!("MSH format {}", words.first().unwrap_or(&""));
                return unsupported(
                    what,
                    "save it in format 4.1 or 2.2: Mesh.MshFileVersion in Gmsh",
                );
            }
        };
        match words[1..] {
            ["0", ..] => Ok(()),
            ["1", "8"] => self.values.byte_order(),
            ["1", size] => unsupported(
                format!("a binary MSH file with numbers of {size} bytes"),
                "save it where numbers have 8 bytes, or as text: Mesh.Binary = 0 in Gmsh",
            ),
            _ => Err(self.values.syntax(
                "the version, the type of the file (0 or 1) and the size of a number are expected",
            )),
        }
    }

    fn physical_names(&mut self) -> Result<(), ImportError> {
        let count = self.values.written("the number of names")?;
        for _ in 0..count {
            let line = self.values.named_line();
            let line = line.ok_or_else(|| self.values.ends("a physical name"))?;
            let (dimension, rest) = first_word(&line);
            let (number, name) = first_word(rest);
            let name = name.trim().trim_matches('"');
            let (Ok(dimension), Ok(number)) = (dimension.parse(), number.parse()) else {
                let what = "a dimension, a number and a name in quotes are expected";
                return Err(self.values.syntax(what));
            };
            self.names.insert((dimension, number), name.to_owned());
        }
        Ok(())
    }

    /// Reads which physical groups the entities belong to.
    fn entities(&mut self) -> Result<(), ImportError> {
        let values = &mut self.values;
        let mut counts = [0; 4];
        for count in &mut counts {
            *count = values.size("the number of entities")?;
        }
        for (dimension, count) in (0u8..).zip(counts) {
            for _ in 0..count {
                let tag = values.int("the number of an entity")?;
                for _ in 0..if dimension == 0 { 3 } else { 6 } {
                    values.real("a bound of an entity")?;
                }
                let groups = values.size("the number of physical groups")?;
                if groups > MOST_GROUPS {
                    let what = format!("an entity of {groups} physical groups");
                    let remedy = "put each entity into a few physical groups at most";
                    return Err(Fault::Unsupported { what, remedy }.at(values.place()));
                }
                for _ in 0..groups {
                    let group = values.int("a physical group")?;
                    self.groups.entry((dimension, tag)).or_default().push(group.saturating_abs());
                }
                if dimension > 0 {
                    for _ in 0..values.size("the number of bounding entities")? {
                        values.int("a bounding entity")?;
                    }
                }
            }
        }
        Ok(())
    }

    /// The number of a node or element.
    fn id(&mut self, what: &str) -> Result<u64, ImportError> {
        match self.version {
            2 => self.values.small(what),
            _ => self.values.size(what),
        }
    }

    fn node(&mut self, id: u64, place: Place, point: Vector3<f64>) -> Result<(), ImportError> {
        if self.indices.insert(id, self.foreign.points.len() as u32).is_some() {
            return Err(Fault::Repeated { what: "node", id }.at(place));
        }
        self.foreign.points.push(point);
        self.foreign.nodes.push(id, place);
        Ok(())
    }

    fn nodes_2(&mut self) -> Result<(), ImportError> {
        let count = self.values.written("the number of nodes")?;
        for _ in 0..count {
            let id = self.id("the number of a node")?;
            let place = self.values.place();
            let point = self.point()?;
            self.node(id, place, point)?;
        }
        Ok(())
    }

    fn point(&mut self) -> Result<Vector3<f64>, ImportError> {
        let mut point = Vector3::zeros();
        for x in &mut point {
            *x = self.values.real("a coordinate")?;
        }
        Ok(point)
    }

    /// Reads the head of the nodes or elements of format 4.1; returns how many blocks follow.
    fn blocks(&mut self) -> Result<u64, ImportError> {
        let blocks = self.values.size("the number of blocks")?;
        for what in ["the number of all members", "the least number", "the largest number"] {
            self.values.size(what)?;
        }
        Ok(blocks)
    }

    fn nodes_4(&mut self) -> Result<(), ImportError> {
        for _ in 0..self.blocks()? {
            let dimension: u8 = self.values.small("the dimension of an entity")?;
            self.values.int("the number of an entity")?;
            let parametric = self.values.int("whether coordinates are parametric")?;
            let count = self.values.size("the number of nodes")?;
            let mut ids = Vec::new();
            for _ in 0..count {
                ids.push(self.id("the number of a node")?);
            }
            for id in ids {
                let point = self.point()?;
                let place = self.values.place();
                for _ in 0..if parametric == 1 { dimension } else { 0 } {
                    self.values.real("a parametric coordinate")?;
                }
                self.node(id, place, point)?;
            }
        }
        Ok(())
    }

    fn elements_2(&mut self) -> Result<(), ImportError> {
        let count = self.values.written("the number of elements")?;
        let mut read = 0u64;
        while read < count {
            if self.values.are_binary() {
                // a block of elements alike
                let kind = self.values.int("the type of elements")?;
                let number: u32 = self.values.small("the number of elements")?;
                let tags = self.values.small("the number of tags")?;
                for _ in 0..number {
                    let id = self.id("the number of an element")?;
                    self.element_2(id, self.values.place(), kind, tags)?;
                }
                read += u64::from(number);
            } else {
                let id = self.id("the number of an element")?;
                let place = self.values.place();
                let kind = self.values.int("the type of an element")?;
                let tags = self.values.small("the number of tags")?;
                self.element_2(id, place, kind, tags)?;
                read += 1;
            }
        }
        Ok(())
    }

    /// Reads the tags of an element of format 2.2, of which the first is its physical group, and its nodes.
    fn element_2(
        &mut self,
        id: u64,
        place: Place,
        kind: i64,
        tags: u32,
    ) -> Result<(), ImportError> {
        let mut group = 0;
        for i in 0..tags {
            let tag = self.values.int("a tag")?;
            if i == 0 {
                group = tag.saturating_abs();
            }
        }
        self.element(id, place, kind, &[group])
    }

    fn elements_4(&mut self) -> Result<(), ImportError> {
        for _ in 0..self.blocks()? {
            let dimension: u8 = self.values.small("the dimension of an entity")?;
            let entity = self.values.int("the number of an entity")?;
            let kind = self.values.int("the type of an element")?;
            let count = self.values.size("the number of elements")?;
            let groups = self.groups.get(&(dimension, entity)).cloned().unwrap_or_default();
            for _ in 0..count {
                let id = self.id("the number of an element")?;
                self.element(id, self.values.place(), kind, &groups)?;
            }
        }
        Ok(())
    }

    /// Reads the nodes of an element, and adds it to the sets of its groups.
    fn element(
        &mut self,
        id: u64,
        place: Place,
        number: i64,
        groups: &[i64],
    ) -> Result<(), ImportError> {
        let (dimension, size) = kind(number)
            .map_err(|kind| Fault::Cell { element: id, kind: kind.into() }.at(place))?;
        let mut nodes = [0u32; 8];
        for node in &mut nodes[..size] {
            let name = self.id("a node of an element")?;
            *node = *self.indices.get(&name).ok_or_else(|| {
                let from = format!("element {id}");
                Fault::Unknown { from, what: format!("node {name}") }.at(self.values.place())
            })?;
        }
        let next = self.foreign.hexes.len() as u32;
        let hex = if dimension == 3 { *self.hexes.entry(id).or_insert(next) } else { next };
        if dimension == 3 && hex == next {
            self.foreign.hexes.push(nodes);
            self.foreign.elements.push(id, place);
        } else if dimension == 3 && self.foreign.hexes[hex as usize] != nodes {
            // format 2.2 repeats an element for each group that it belongs to
            return Err(Fault::Repeated { what: "element", id }.at(place));
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

/// The first word of a text, and what comes after it.
fn first_word(text: &str) -> (&str, &str) {
    text.trim_start().split_once(char::is_whitespace).unwrap_or_default()
}
