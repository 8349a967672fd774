//! Abaqus input files.
//!
//! Source: Abaqus Keywords Reference Guide: `*NODE`, `*ELEMENT`, `*NSET`, `*ELSET`, `*SURFACE`. The
//! file must be flat, without parts and instances. Keywords that do not concern the mesh are ignored; those that
//! would make or move nodes are refused.
//!
//! No Rust library for this format was found.

use super::error::{Fault, ImportError};
use super::foreign::Foreign;
use super::text::{Text, number};
use crate::HEX_FACES;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Reads an Abaqus input file. Elements of the C3D8 family are hexahedra; quadrangles in an element set or a
/// surface are its faces, lines in an element set give it their nodes.
///
/// # Errors
/// [`Fault::Syntax`], [`Fault::Repeated`] or [`Fault::Unknown`] for a file that does not follow the format,
/// [`Fault::Cell`] for other elements, and [`Fault::Unsupported`] for keywords that make or move nodes.
pub fn read_abaqus(bytes: &[u8]) -> Result<Foreign, ImportError> {
    let mut reader = Reader::default();
    let mut text = Text::new(bytes)?;
    while let Some(line) = text.next_line() {
        reader.line(line, text.line)?;
    }
    reader.end_block(text.line)?;
    Ok(reader.finish())
}

/// What the data lines after a keyword hold.
#[derive(Clone, Debug, Default, PartialEq)]
enum Block {
    #[default]
    Outside,
    Ignored,
    Node {
        set: Option<String>,
    },
    Element {
        shape: CellType,
        set: Option<String>,
    },
    Refused {
        kind: String,
    },
    NodeSet {
        name: String,
        generate: bool,
    },
    ElementSet {
        name: String,
        generate: bool,
    },
    ElementSurface {
        name: String,
    },
    NodeSurface {
        name: String,
    },
}

/// Type of an element, by its shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum CellType {
    Hex,
    Quad,
    Line,
}

/// An element of the file: a hexahedron by its index, others by the indices of their nodes.
#[derive(Clone, Copy)]
enum Cell {
    Hex(u32),
    Quad([u32; 4]),
    Line([u32; 2]),
}

/// Members of a surface.
#[derive(Default)]
struct SurfaceMembers {
    /// Numbers of elements with a side of each: 1 to 6 of a hexahedron, 0 for a quadrangle or line itself.
    sides: BTreeSet<(u64, usize)>,
    nodes: BTreeSet<u32>,
}

#[derive(Default)]
struct Reader {
    foreign: Foreign,
    block: Block,
    /// Numbers read so far of an element that continues over several lines, and the line on which it began.
    pending: Vec<u64>,
    began: usize,
    /// Indices of nodes by their numbers.
    nodes: HashMap<u64, u32>,
    cells: HashMap<u64, Cell>,
    /// Sets by their names in capitals, since Abaqus ignores letter case; `spelling` has the name as first written.
    node_sets: BTreeMap<String, BTreeSet<u32>>,
    element_sets: BTreeMap<String, BTreeSet<u64>>,
    surfaces: BTreeMap<String, SurfaceMembers>,
    spelling: BTreeMap<String, String>,
    /// Keywords that were ignored.
    ignored: BTreeSet<String>,
    /// Sets that name nodes or elements which the file does not have.
    incomplete: BTreeSet<String>,
}

/// Keywords that would make, move or copy nodes and elements.
const MAKERS: &[(&str, &str)] = &[
    ("INCLUDE", "put the included lines into the file itself"),
    ("PART", FLAT),
    ("ASSEMBLY", FLAT),
    ("INSTANCE", FLAT),
    ("SYSTEM", "give the coordinates in the global system"),
    ("NGEN", WRITTEN_OUT),
    ("NFILL", WRITTEN_OUT),
    ("NCOPY", WRITTEN_OUT),
    ("NMAP", WRITTEN_OUT),
    ("ELGEN", WRITTEN_OUT),
    ("ELCOPY", WRITTEN_OUT),
];
const FLAT: &str = "write a flat input file: in Abaqus/CAE, Model > Edit Attributes > Do not use \
                    parts and assemblies in input files";
const WRITTEN_OUT: &str = "write every node and element out";

/// Corners of the faces S1 to S6, as sides of [`HEX_FACES`].
const SIDES: [usize; 6] = [4, 5, 2, 1, 3, 0];

impl Reader {
    fn line(&mut self, line: &str, at: usize) -> Result<(), ImportError> {
        if line.is_empty() || line.starts_with("**") {
            return Ok(());
        }
        if let Some(keyword) = line.strip_prefix('*') {
            self.end_block(at)?;
            self.block = self.keyword(keyword, at)?;
            return Ok(());
        }
        // Taken out for the borrow checker; data lines do not change it.
        let block = std::mem::take(&mut self.block);
        let done = self.data(&block, line, at);
        self.block = block;
        done
    }

    fn keyword(&mut self, line: &str, at: usize) -> Result<Block, ImportError> {
        let mut words = line.split(',').map(str::trim);
        let name = words.next().unwrap_or_default().to_uppercase();
        if let Some((_, remedy)) = MAKERS.iter().find(|(maker, _)| *maker == name) {
            return Err(Fault::Unsupported { what: format!("*{name}"), remedy }.at(at));
        }
        let mut parameters = BTreeMap::new();
        for word in words.filter(|word| !word.is_empty()) {
            let (key, value) = word.split_once('=').unwrap_or((word, ""));
            let value = value.trim().trim_matches('"').to_owned();
            parameters.insert(key.trim().to_uppercase(), value);
        }
        let need = |key: &str| {
            let found = parameters.get(key).filter(|name| !name.is_empty()).cloned();
            found.ok_or_else(|| Fault::Syntax { what: format!("*{name} needs {key}=") }.at(at))
        };
        let generate = parameters.contains_key("GENERATE");
        if parameters.contains_key("INPUT") {
            let what = format!("*{name} with INPUT=");
            return Err(Fault::Unsupported { what, remedy: MAKERS[0].1 }.at(at));
        }
        Ok(match name.as_str() {
            "NODE" => {
                if parameters.get("SYSTEM").is_some_and(|system| !system.eq_ignore_ascii_case("R"))
                {
                    let what = "*NODE with SYSTEM=".into();
                    let remedy = "give rectangular coordinates";
                    return Err(Fault::Unsupported { what, remedy }.at(at));
                }
                Block::Node { set: parameters.get("NSET").cloned() }
            }
            "ELEMENT" => {
                let kind = need("TYPE")?;
                match cell_type_of(&kind) {
                    Some(shape) => Block::Element { shape, set: parameters.get("ELSET").cloned() },
                    None => Block::Refused { kind },
                }
            }
            "NSET" => Block::NodeSet { name: need("NSET")?, generate },
            "ELSET" => Block::ElementSet { name: need("ELSET")?, generate },
            "SURFACE" => {
                let kind = parameters.get("TYPE").map_or("ELEMENT", String::as_str).to_uppercase();
                match kind.as_str() {
                    "ELEMENT" => Block::ElementSurface { name: need("NAME")? },
                    "NODE" => Block::NodeSurface { name: need("NAME")? },
                    _ => Block::Ignored,
                }
            }
            "HEADING" => Block::Ignored,
            _ => {
                self.ignored.insert(format!("*{name}"));
                Block::Ignored
            }
        })
    }

    fn data(&mut self, block: &Block, line: &str, at: usize) -> Result<(), ImportError> {
        match block {
            Block::Ignored => Ok(()),
            Block::Outside => {
                let what = "a keyword that starts with * is expected".into();
                Err(Fault::Syntax { what }.at(at))
            }
            Block::Refused { kind } => {
                let first = words(line).next().unwrap_or_default();
                let element =
                    number(first, "the number of an element").map_err(|fault| fault.at(at))?;
                Err(Fault::Cell { element, kind: format!("of the type {kind}") }.at(at))
            }
            Block::Node { set } => self.node(set.as_deref(), line, at),
            Block::Element { shape, set } => self.part_of_element(*shape, set.as_deref(), line, at),
            Block::NodeSet { name, generate: true } => {
                let steps = self.generated(line, at)?;
                let nodes = within(&steps, &self.nodes);
                self.node_set(name).extend(nodes.into_iter().map(|(_, index)| index));
                Ok(())
            }
            Block::NodeSet { name, generate: false } => {
                for word in words(line) {
                    let members = self.named_nodes(word);
                    let members = self.found(members, "nodes", name, at);
                    self.node_set(name).extend(members);
                }
                Ok(())
            }
            Block::ElementSet { name, generate: true } => {
                let steps = self.generated(line, at)?;
                let ids: Vec<u64> = within(&steps, &self.cells).into_iter().map(|c| c.0).collect();
                self.element_set(name).extend(ids);
                Ok(())
            }
            Block::ElementSet { name, generate: false } => {
                for word in words(line) {
                    let members = self.named_elements(word);
                    let members = self.found(members, "elements", name, at);
                    self.element_set(name).extend(members);
                }
                Ok(())
            }
            Block::ElementSurface { name } => self.sides(name, line, at),
            Block::NodeSurface { name } => {
                let word = line.split(',').next().unwrap_or_default().trim();
                let nodes =
                    self.named_nodes(word).ok_or_else(|| unknown("node", word, name, at))?;
                self.surface(name).nodes.extend(nodes);
                Ok(())
            }
        }
    }

    /// A node: its number and coordinates, of which those left out are zero.
    fn node(&mut self, set: Option<&str>, line: &str, at: usize) -> Result<(), ImportError> {
        let bare = |fault: Fault| fault.at(at);
        let mut words = line.split(',').map(str::trim);
        let first = words.next().unwrap_or_default();
        let id = number(first, "the number of a node").map_err(bare)?;
        let mut point = [0.0; 3];
        for x in &mut point {
            match words.next().unwrap_or_default() {
                "" => {}
                word => *x = number(word, "a coordinate").map_err(bare)?,
            }
        }
        let index = self.foreign.points.len() as u32;
        if self.nodes.insert(id, index).is_some() {
            return Err(Fault::Repeated { what: "node", id }.at(at));
        }
        self.foreign.points.push(point);
        self.foreign.nodes.push(id, at);
        if let Some(set) = set {
            self.node_set(set).insert(index);
        }
        Ok(())
    }

    /// A line of an element, whose nodes may stand on several.
    fn part_of_element(
        &mut self,
        shape: CellType,
        set: Option<&str>,
        line: &str,
        at: usize,
    ) -> Result<(), ImportError> {
        if self.pending.is_empty() {
            self.began = at;
        }
        for word in words(line) {
            let n = number(word, "the number of an element or node");
            self.pending.push(n.map_err(|fault| fault.at(at))?);
        }
        let size = 1 + shape.nodes();
        if self.pending.len() > size {
            let what = format!("an element of {} nodes has too many", shape.nodes());
            return Err(Fault::Syntax { what }.at(at));
        }
        if self.pending.len() == size {
            self.element(shape, set)?;
            self.pending.clear();
        }
        Ok(())
    }

    /// Faces of a surface: an element or a set of them, and the face S1 to S6.
    fn sides(&mut self, name: &str, line: &str, at: usize) -> Result<(), ImportError> {
        let mut words = line.split(',').map(str::trim);
        let word = words.next().unwrap_or_default();
        let members =
            self.named_elements(word).ok_or_else(|| unknown("element", word, name, at))?;
        let side = words.next().unwrap_or_default().to_uppercase();
        let mut sides = Vec::new();
        for id in members {
            let number = side.strip_prefix('S').and_then(|s| s.parse().ok());
            match (self.cells.get(&id), number) {
                (Some(Cell::Hex(_)), Some(side @ 1..=6)) => sides.push((id, side)),
                (Some(Cell::Hex(_)), _) => {
                    let what = "a face S1 to S6 of the elements is expected".into();
                    return Err(Fault::Syntax { what }.at(at));
                }
                _ => sides.push((id, 0)),
            }
        }
        self.surface(name).sides.extend(sides);
        Ok(())
    }

    /// Ends the data of a keyword: an element must not be incomplete.
    fn end_block(&mut self, at: usize) -> Result<(), ImportError> {
        match self.pending.first() {
            None => Ok(()),
            Some(id) => {
                let what = format!("element {id} ends before all its nodes are named");
                Err(Fault::Syntax { what }.at(at))
            }
        }
    }

    fn element(&mut self, shape: CellType, set: Option<&str>) -> Result<(), ImportError> {
        let id = self.pending[0];
        let mut nodes = [0u32; 8];
        for (node, name) in nodes.iter_mut().zip(&self.pending[1..]) {
            *node = *self.nodes.get(name).ok_or_else(|| {
                let from = format!("element {id}");
                Fault::Unknown { from, what: format!("node {name}") }.at(self.began)
            })?;
        }
        let [a, b, c, d, ..] = nodes;
        let cell = match shape {
            CellType::Hex => Cell::Hex(self.foreign.hexes.len() as u32),
            CellType::Quad => Cell::Quad([a, b, c, d]),
            CellType::Line => Cell::Line([a, b]),
        };
        if self.cells.insert(id, cell).is_some() {
            return Err(Fault::Repeated { what: "element", id }.at(self.began));
        }
        if shape == CellType::Hex {
            self.foreign.hexes.push(nodes);
            self.foreign.elements.push(id, self.began);
        }
        if let Some(set) = set {
            self.element_set(set).insert(id);
        }
        Ok(())
    }

    fn node_set(&mut self, name: &str) -> &mut BTreeSet<u32> {
        let key = self.key(name);
        self.node_sets.entry(key).or_default()
    }

    fn element_set(&mut self, name: &str) -> &mut BTreeSet<u64> {
        let key = self.key(name);
        self.element_sets.entry(key).or_default()
    }

    fn surface(&mut self, name: &str) -> &mut SurfaceMembers {
        let key = self.key(name);
        self.surfaces.entry(key).or_default()
    }

    /// The key of a name in the maps of sets; keeps its spelling.
    fn key(&mut self, name: &str) -> String {
        let key = name.to_uppercase();
        self.spelling.entry(key.clone()).or_insert_with(|| name.to_owned());
        key
    }

    /// A node by its number, or the nodes of a set.
    fn named_nodes(&self, word: &str) -> Option<Vec<u32>> {
        match word.parse::<u64>() {
            Ok(id) => self.nodes.get(&id).map(|&index| vec![index]),
            Err(_) => self.node_sets.get(&word.to_uppercase()).map(|s| s.iter().copied().collect()),
        }
    }

    /// An element by its number, or the elements of a set.
    fn named_elements(&self, word: &str) -> Option<Vec<u64>> {
        match word.parse::<u64>() {
            Ok(id) => self.cells.contains_key(&id).then(|| vec![id]),
            Err(_) => {
                self.element_sets.get(&word.to_uppercase()).map(|s| s.iter().copied().collect())
            }
        }
    }

    /// The members that a word of a set names. A set may name some that the file does not have: a note says so.
    fn found<T>(&mut self, named: Option<Vec<T>>, what: &str, set: &str, at: usize) -> Vec<T> {
        if named.is_none() && self.incomplete.insert(set.to_uppercase()) {
            let note = format!("set `{set}` names {what} that are not there (line {at}); left out");
            self.foreign.notes.push(note);
        }
        named.unwrap_or_default()
    }

    /// First number, last number and increment of a data line with `GENERATE`.
    fn generated(&self, line: &str, at: usize) -> Result<[u64; 3], ImportError> {
        let mut steps = [0, 0, 1];
        let mut words = line.split(',').map(str::trim).filter(|word| !word.is_empty());
        for (i, step) in steps.iter_mut().enumerate() {
            match words.next() {
                Some(word) => {
                    *step = number(word, "first, last and increment").map_err(|f| f.at(at))?;
                }
                None if i == 2 => {}
                None => {
                    let what = "first, last and increment are expected".into();
                    return Err(Fault::Syntax { what }.at(at));
                }
            }
        }
        Ok(steps)
    }

    /// Puts sets and surfaces under their names; node set, element set and surface of one name become one set.
    fn finish(self) -> Foreign {
        let Self {
            mut foreign, node_sets, element_sets, surfaces, spelling, cells, ignored, ..
        } = self;
        let name = |key: &String| spelling.get(key).unwrap_or(key).clone();
        for (key, nodes) in &node_sets {
            foreign.set(&name(key)).nodes.extend(nodes);
        }
        for (key, ids) in &element_sets {
            let set = foreign.set(&name(key));
            for id in ids {
                match cells.get(id) {
                    Some(Cell::Hex(hex)) => set.hexes.push(*hex),
                    Some(Cell::Quad(nodes)) => set.faces.push(*nodes),
                    Some(Cell::Line(nodes)) => set.nodes.extend(nodes),
                    None => {}
                }
            }
        }
        for (key, surface) in surfaces {
            let mut faces = Vec::new();
            for (id, side) in surface.sides {
                match cells.get(&id) {
                    Some(Cell::Hex(hex)) => {
                        let nodes = foreign.hexes[*hex as usize];
                        faces.push(HEX_FACES[SIDES[side - 1]].map(|c| nodes[c]));
                    }
                    Some(Cell::Quad(nodes)) => faces.push(*nodes),
                    Some(Cell::Line(_)) | None => {}
                }
            }
            let set = foreign.set(&name(&key));
            set.nodes.extend(surface.nodes);
            set.faces.extend(faces);
        }
        if !ignored.is_empty() {
            let words: Vec<_> = ignored.into_iter().take(20).collect();
            let words = words.join(", ");
            foreign.notes.push(format!("passed over, for the case says it: {words}"));
        }
        foreign
    }
}

impl CellType {
    fn nodes(self) -> usize {
        match self {
            Self::Hex => 8,
            Self::Quad => 4,
            Self::Line => 2,
        }
    }
}

/// The shape of an element type, if it is a linear hexahedron, quadrangle or line. Its integration does not matter:
/// the case chooses that.
fn cell_type_of(kind: &str) -> Option<CellType> {
    const QUADS: [&str; 9] =
        ["S4", "M3D4", "R3D4", "SFM3D4", "CPS4", "CPE4", "CPEG4", "CAX4", "DS4"];
    let kind = kind.to_uppercase();
    // letters may follow: hybrid, reduced integration, incompatible modes
    let is = |name: &str| {
        let rest = kind.strip_prefix(name);
        rest.is_some_and(|rest| rest.chars().all(|c| c.is_ascii_alphabetic()))
    };
    if is("C3D8") {
        Some(CellType::Hex)
    } else if QUADS.into_iter().any(is) {
        Some(CellType::Quad)
    } else {
        ["T3D2", "B31", "R3D2"].into_iter().any(is).then_some(CellType::Line)
    }
}

/// The words between the commas of a line.
fn words(line: &str) -> impl Iterator<Item = &str> {
    line.split(',').map(str::trim).filter(|word| !word.is_empty())
}

fn unknown(what: &str, word: &str, surface: &str, at: usize) -> ImportError {
    let word: String = word.chars().take(40).collect();
    let from = format!("surface `{surface}`");
    Fault::Unknown { from, what: format!("{what} or set `{word}`") }.at(at)
}

/// The entries of `all` whose numbers are first, first + increment, and so on up to last, in order.
fn within<T: Copy>([first, last, step]: &[u64; 3], all: &HashMap<u64, T>) -> Vec<(u64, T)> {
    let step = (*step).max(1);
    // few numbers are looked up, not looked for
    if last.saturating_sub(*first) / step < all.len() as u64 {
        let ids = (*first..=*last).step_by(usize::try_from(step).unwrap_or(usize::MAX));
        return ids.filter_map(|id| Some((id, *all.get(&id)?))).collect();
    }
    let mut found: Vec<(u64, T)> = all
        .iter()
        .filter(|(id, _)| (*first..=*last).contains(id) && (*id - first).is_multiple_of(step))
        .map(|(id, value)| (*id, *value))
        .collect();
    found.sort_unstable_by_key(|(id, _)| *id);
    found
}

/// A foreign mesh as the text of an Abaqus input file. Reading it again gives the same coordinates to the last bit.
///
/// Hexahedra become C3D8R, faces of sets S4 elements. Nodes and hexahedra keep the numbers of their labels; without
/// labels they are counted from 1.
pub fn write_abaqus(mesh: &Foreign) -> String {
    let Foreign { points, hexes, sets, nodes, elements, .. } = mesh;
    // indices from 0 become numbers from 1
    let node = |n: usize| if nodes.ids.is_empty() { n as u64 + 1 } else { nodes.id(n) };
    let hex = |e: usize| if elements.ids.is_empty() { e as u64 + 1 } else { elements.id(e) };
    let row =
        |numbers: &[u64]| numbers.iter().map(u64::to_string).collect::<Vec<_>>().join(", ") + "\n";
    let mut text = String::from("*HEADING\n*NODE\n");
    for (n, [x, y, z]) in points.iter().enumerate() {
        text += &format!("{}, {x:?}, {y:?}, {z:?}\n", node(n));
    }
    text += "*ELEMENT, TYPE=C3D8R\n";
    let mut last = 0;
    for (e, corners) in hexes.iter().enumerate() {
        last = last.max(hex(e));
        let mut numbers = vec![hex(e)];
        numbers.extend(corners.map(|n| node(n as usize)));
        text += &row(&numbers);
    }
    for (name, set) in sets {
        if !set.faces.is_empty() {
            text += &format!("*ELEMENT, TYPE=S4, ELSET={name}\n");
            for face in &set.faces {
                last += 1;
                let [a, b, c, d] = face.map(|n| node(n as usize));
                text += &row(&[last, a, b, c, d]);
            }
        }
        let numbers = |indices: &[u32], of: &dyn Fn(usize) -> u64| -> Vec<u64> {
            indices.iter().map(|&index| of(index as usize)).collect()
        };
        let kinds = [("NSET", numbers(&set.nodes, &node)), ("ELSET", numbers(&set.hexes, &hex))];
        for (kind, numbers) in kinds.iter().filter(|(_, numbers)| !numbers.is_empty()) {
            text += &format!("*{kind}, {kind}={name}\n");
            numbers.chunks(16).for_each(|chunk| text += &row(chunk));
        }
    }
    text
}
