//! Abaqus input files.
//!
//! Source: Abaqus Keywords Reference Guide: `*NODE`, `*ELEMENT`, `*NSET`, `*ELSET`, `*SURFACE`. The
//! file must be flat, without parts and instances. Keywords that do not concern the mesh are ignored; those that
//! would make or move nodes are refused.
//!
//! No Rust library for this format was found.

mod keyword;

use super::error::{Fault, ImportError};
use super::foreign::Foreign;
use super::text::{Text, decoded, number};
use crate::HEX_FACES;
use keyword::{Keyword, Name, fields, goes_on};
use nalgebra::Vector3;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Reads an Abaqus input file. Elements of the C3D8 family are hexahedra; quadrangles in an element set or a
/// surface are its faces, lines in an element set give it their nodes.
///
/// # Errors
/// [`Fault::Syntax`], [`Fault::Repeated`] or [`Fault::Unknown`] for a file that does not follow the format,
/// [`Fault::Cell`] for other elements, and [`Fault::Unsupported`] for keywords that make or move nodes and for
/// parameters that are not read.
pub fn read_abaqus(bytes: &[u8]) -> Result<Foreign, ImportError> {
    let mut reader = Reader::default();
    let text = decoded(bytes)?;
    let mut text = Text::new(&text);
    while let Some(line) = text.next_line() {
        reader.line(line, text.line)?;
    }
    reader.end_keyword()?;
    reader.end_block(text.line)?;
    Ok(reader.finish())
}

/// What the data lines after a keyword hold; sets and surfaces by their keys.
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
        set: String,
        generate: bool,
    },
    ElementSet {
        set: String,
        generate: bool,
    },
    ElementSurface {
        set: String,
    },
    NodeSurface {
        set: String,
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
    /// The keyword line, without its `*`, that goes on in the next line, and where it begins.
    open: Option<(String, usize)>,
    /// Numbers read so far of an element that continues over several lines, and the line on which it began.
    pending: Vec<u64>,
    began: usize,
    /// Indices of nodes by their numbers.
    nodes: HashMap<u64, u32>,
    cells: HashMap<u64, Cell>,
    /// Sets by the keys of their names; `spelling` has the name as first written, and whether it stood in quotes.
    node_sets: BTreeMap<String, BTreeSet<u32>>,
    element_sets: BTreeMap<String, BTreeSet<u64>>,
    surfaces: BTreeMap<String, SurfaceMembers>,
    spelling: BTreeMap<String, (String, bool)>,
    /// Keywords that were ignored.
    ignored: BTreeSet<String>,
    /// Sets that name members which the file does not have, with the first of these.
    incomplete: BTreeMap<String, ImportError>,
}

/// Keywords that are read.
const READ: [&str; 5] = ["NODE", "ELEMENT", "NSET", "ELSET", "SURFACE"];

/// Parameters of sets that say nothing of their members.
const HARMLESS: [&str; 2] = ["INTERNAL", "UNSORTED"];

/// Keywords that would make, move or copy nodes and elements.
const MAKERS: &[(&str, &str)] = &[
    ("INCLUDE", INCLUDED),
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
    ("IMPORT", WRITTEN_OUT),
    ("IMPERFECTION", WRITTEN_OUT),
    ("SYMMETRICMODELGENERATION", WRITTEN_OUT),
];
const INCLUDED: &str = "put the included lines into the file itself";
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
            self.end_keyword()?;
            self.end_block(at)?;
            self.open = Some((keyword.to_owned(), at));
            return if goes_on(keyword) { Ok(()) } else { self.end_keyword() };
        }
        // no parameter begins with a digit
        if let Some((keyword, _)) = &mut self.open
            && !line.starts_with(|c: char| c.is_ascii_digit())
        {
            *keyword += line;
            return if goes_on(line) { Ok(()) } else { self.end_keyword() };
        }
        self.end_keyword()?;
        // Taken out for the borrow checker; data lines do not change it.
        let block = std::mem::take(&mut self.block);
        let done = self.data(&block, line, at);
        self.block = block;
        done
    }

    /// Reads the keyword whose lines have ended.
    fn end_keyword(&mut self) -> Result<(), ImportError> {
        if let Some((line, at)) = self.open.take() {
            self.block = self.keyword(Keyword::of(&line, at)?)?;
        }
        Ok(())
    }

    fn keyword(&mut self, mut keyword: Keyword) -> Result<Block, ImportError> {
        let Keyword { name, at, .. } = &keyword;
        let (name, at) = (name.clone(), *at);
        if let Some((_, remedy)) = MAKERS.iter().find(|(maker, _)| *maker == name) {
            return Err(Fault::Unsupported { what: format!("*{name}"), remedy }.at(at));
        }
        let known = READ.into_iter().chain(MAKERS.iter().map(|(maker, _)| *maker));
        if let Some(long) = known.filter(|k| *k != name).find(|k| k.starts_with(&name)) {
            let what = format!("*{name}, which may stand for *{long},");
            return Err(Fault::Unsupported { what, remedy: "write the keyword in full" }.at(at));
        }
        match name.as_str() {
            "NODE" => {
                let set = self.set_of(&mut keyword, "NSET")?;
                if let Some(system) = keyword.word("SYSTEM")?.filter(|system| system != "R") {
                    return Err(keyword.refused("SYSTEM", Some(&system)));
                }
                keyword.end(&[])?;
                Ok(Block::Node { set })
            }
            "ELEMENT" => {
                let kind = keyword.word("TYPE")?.ok_or_else(|| keyword.lacks("TYPE"))?;
                let set = self.set_of(&mut keyword, "ELSET")?;
                keyword.end(&[])?;
                Ok(match cell_type_of(&kind) {
                    Some(shape) => Block::Element { shape, set },
                    None => Block::Refused { kind },
                })
            }
            "NSET" => {
                let set = self.needed_set(&mut keyword, "NSET")?;
                self.node_set(&set);
                if let Some(of) = keyword.value("ELSET")? {
                    keyword.end(&HARMLESS)?;
                    self.nodes_of_elements(&set, Name::of(&of), at);
                    // no data follow
                    return Ok(Block::Outside);
                }
                let generate = keyword.flag("GENERATE")?;
                keyword.end(&HARMLESS)?;
                Ok(Block::NodeSet { set, generate })
            }
            "ELSET" => {
                let set = self.needed_set(&mut keyword, "ELSET")?;
                self.element_set(&set);
                let generate = keyword.flag("GENERATE")?;
                keyword.end(&HARMLESS)?;
                Ok(Block::ElementSet { set, generate })
            }
            "SURFACE" => {
                let kind = keyword.word("TYPE")?.unwrap_or_else(|| "ELEMENT".into());
                let nodes = kind == "NODE";
                if !nodes && kind != "ELEMENT" {
                    self.ignored.insert(format!("*SURFACE, TYPE={kind}"));
                    return Ok(Block::Ignored);
                }
                let set = self.needed_set(&mut keyword, "NAME")?;
                // faces that are listed are not trimmed
                keyword.end(&["INTERNAL", "TRIM", "MAXRATIO"])?;
                Ok(if nodes { Block::NodeSurface { set } } else { Block::ElementSurface { set } })
            }
            "HEADING" => Ok(Block::Ignored),
            _ => {
                self.ignored.insert(format!("*{name}"));
                Ok(Block::Ignored)
            }
        }
    }

    /// Takes the name of a set from a parameter; returns its key.
    fn set_of(&mut self, keyword: &mut Keyword, key: &str) -> Result<Option<String>, ImportError> {
        let Some(value) = keyword.value(key)? else { return Ok(None) };
        let name = Name::of(&value);
        let spelling = (name.text.to_owned(), name.quoted);
        let (first, quoted) = self.spelling.entry(name.key()).or_insert(spelling);
        if (name.quoted || *quoted) && first != name.text {
            let what = format!("a set `{}` beside a set `{first}`", name.text);
            let remedy = "give the sets names that differ by more than letter case";
            return Err(Fault::Unsupported { what, remedy }.at(keyword.at));
        }
        Ok(Some(name.key()))
    }

    fn needed_set(&mut self, keyword: &mut Keyword, key: &str) -> Result<String, ImportError> {
        self.set_of(keyword, key)?.ok_or_else(|| keyword.lacks(key))
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
            Block::NodeSet { set, generate: true } => {
                let steps = generated(line, at)?;
                let found = within(&steps, &self.nodes);
                self.lacks_generated(set, "node", &steps, found.iter().map(|node| node.0), at);
                self.node_set(set).extend(found.into_iter().map(|(_, index)| index));
                Ok(())
            }
            Block::NodeSet { set, generate: false } => {
                for word in fields(line).filter(|word| !word.is_empty()).map(Name::of) {
                    match self.named_nodes(word) {
                        Some(members) => self.node_set(set).extend(members),
                        None => self.lacks(set, member("node", word), at),
                    }
                    self.lacks_as(set, word);
                }
                Ok(())
            }
            Block::ElementSet { set, generate: true } => {
                let steps = generated(line, at)?;
                let found: Vec<u64> =
                    within(&steps, &self.cells).into_iter().map(|c| c.0).collect();
                self.lacks_generated(set, "element", &steps, found.iter().copied(), at);
                self.element_set(set).extend(found);
                Ok(())
            }
            Block::ElementSet { set, generate: false } => {
                for word in fields(line).filter(|word| !word.is_empty()).map(Name::of) {
                    match self.named_elements(word) {
                        Some(members) => self.element_set(set).extend(members),
                        None => self.lacks(set, member("element", word), at),
                    }
                    self.lacks_as(set, word);
                }
                Ok(())
            }
            Block::ElementSurface { set } => self.sides(set, line, at),
            Block::NodeSurface { set } => {
                let word = Name::of(fields(line).next().unwrap_or_default());
                match self.named_nodes(word) {
                    Some(nodes) => self.surface(set).nodes.extend(nodes),
                    None => self.lacks(set, member("node", word), at),
                }
                self.lacks_as(set, word);
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
        if line.ends_with(',') && line.matches(',').count() < 4 {
            let what = format!("node {id} ends with a comma before its three coordinates");
            return Err(bare(Fault::Syntax { what }));
        }
        let mut point = Vector3::zeros();
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

    /// Faces of a surface: an element or a set of them, and which of its faces.
    fn sides(&mut self, surface: &str, line: &str, at: usize) -> Result<(), ImportError> {
        let mut words = fields(line);
        let word = Name::of(words.next().unwrap_or_default());
        let side = words.next().unwrap_or_default().to_uppercase();
        let number = side.strip_prefix('S').and_then(|s| s.parse().ok());
        let Some(members) = self.named_elements(word) else {
            self.lacks(surface, member("element", word), at);
            return Ok(());
        };
        self.lacks_as(surface, word);
        let mut sides = Vec::new();
        for id in members {
            let side = match (self.cells.get(&id), number, side.as_str()) {
                (Some(Cell::Hex(_)), Some(side @ 1..=6), _) => side,
                (Some(Cell::Quad(_)), _, "" | "SPOS" | "SNEG") => 0,
                _ => {
                    let what = format!(
                        "a face of element {id} is expected, found `{side}`: S1 to S6 of a hexahedron, SPOS or SNEG \
                         of a quadrangle"
                    );
                    return Err(Fault::Syntax { what }.at(at));
                }
            };
            sides.push((id, side));
        }
        self.surface(surface).sides.extend(sides);
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

    fn node_set(&mut self, key: &str) -> &mut BTreeSet<u32> {
        self.node_sets.entry(key.to_owned()).or_default()
    }

    fn element_set(&mut self, key: &str) -> &mut BTreeSet<u64> {
        self.element_sets.entry(key.to_owned()).or_default()
    }

    fn surface(&mut self, key: &str) -> &mut SurfaceMembers {
        self.surfaces.entry(key.to_owned()).or_default()
    }

    /// A node by its number, or the nodes of a set.
    fn named_nodes(&self, name: Name) -> Option<Vec<u32>> {
        match name.number() {
            Some(id) => self.nodes.get(&id).map(|&index| vec![index]),
            None => self.node_sets.get(&name.key()).map(|s| s.iter().copied().collect()),
        }
    }

    /// An element by its number, or the elements of a set.
    fn named_elements(&self, name: Name) -> Option<Vec<u64>> {
        match name.number() {
            Some(id) => self.cells.contains_key(&id).then(|| vec![id]),
            None => self.element_sets.get(&name.key()).map(|s| s.iter().copied().collect()),
        }
    }

    /// Puts the nodes of the elements of a set into a node set.
    fn nodes_of_elements(&mut self, set: &str, of: Name, at: usize) {
        let Some(elements) = self.element_sets.get(&of.key()) else {
            return self.lacks(set, member("element", of), at);
        };
        let mut nodes = BTreeSet::new();
        for id in elements {
            match self.cells.get(id) {
                Some(Cell::Hex(hex)) => nodes.extend(self.foreign.hexes[*hex as usize]),
                Some(Cell::Quad(corners)) => nodes.extend(corners),
                Some(Cell::Line(ends)) => nodes.extend(ends),
                None => {}
            }
        }
        self.node_set(set).extend(nodes);
        self.lacks_as(set, of);
    }

    /// Notes that a set names something which the file does not have.
    fn lacks(&mut self, set: &str, what: String, at: usize) {
        let from = format!("set `{}`", self.spelling.get(set).map_or(set, |(name, _)| name));
        let fault = Fault::Unknown { from, what };
        self.incomplete.entry(set.to_owned()).or_insert_with(|| fault.at(at));
    }

    /// Notes that a set lacks what another lacks that it names.
    fn lacks_as(&mut self, set: &str, other: Name) {
        if other.number().is_none()
            && let Some(error) = self.incomplete.get(&other.key()).cloned()
        {
            self.incomplete.entry(set.to_owned()).or_insert(error);
        }
    }

    /// Notes the first number of a generated set that none of those `found`, in order, has.
    fn lacks_generated(
        &mut self,
        set: &str,
        kind: &str,
        [first, last, step]: &[u64; 3],
        mut found: impl Iterator<Item = u64>,
        at: usize,
    ) {
        let mut all = (*first..=*last).step_by(usize::try_from(*step).unwrap_or(usize::MAX));
        if let Some(id) = all.find(|id| found.next() != Some(*id)) {
            self.lacks(set, format!("{kind} {id}"), at);
        }
    }

    /// Puts sets and surfaces under their names; node set, element set and surface of one name become one set.
    fn finish(self) -> Foreign {
        let Self {
            mut foreign,
            node_sets,
            element_sets,
            surfaces,
            spelling,
            cells,
            ignored,
            incomplete,
            ..
        } = self;
        let name = |key: &String| spelling.get(key).map_or(key, |(name, _)| name).clone();
        foreign.incomplete =
            incomplete.into_iter().map(|(key, error)| (name(&key), error)).collect();
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

/// A member of a set: by its number, or the set of a name.
fn member(kind: &str, name: Name) -> String {
    match name.number() {
        Some(id) => format!("{kind} {id}"),
        None => format!("the {kind} set `{}`", name.text.chars().take(40).collect::<String>()),
    }
}

/// First number, last number and increment of a data line with `GENERATE`.
fn generated(line: &str, at: usize) -> Result<[u64; 3], ImportError> {
    let mut steps: Vec<u64> = Vec::new();
    for word in words(line) {
        steps.push(number(word, "first, last and increment").map_err(|fault| fault.at(at))?);
    }
    let [first, last, step] = match steps[..] {
        [first, last] => [first, last, 1],
        [first, last, step] => [first, last, step],
        _ => [1, 0, 0],
    };
    if step == 0 || first > last || !(last - first).is_multiple_of(step) {
        let what = "first, last and increment are expected, which leads from the first to the last";
        return Err(Fault::Syntax { what: what.into() }.at(at));
    }
    Ok([first, last, step])
}

/// The entries of `all` whose numbers are first, first + increment, and so on up to last, in order.
fn within<T: Copy>([first, last, step]: &[u64; 3], all: &HashMap<u64, T>) -> Vec<(u64, T)> {
    // few numbers are looked up, not looked for
    if (last - first) / step < all.len() as u64 {
        let ids = (*first..=*last).step_by(usize::try_from(*step).unwrap_or(usize::MAX));
        return ids.filter_map(|id| Some((id, *all.get(&id)?))).collect();
    }
    let mut found: Vec<(u64, T)> = all
        .iter()
        .filter(|(id, _)| (*first..=*last).contains(id) && (*id - first).is_multiple_of(*step))
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
    for (n, p) in points.iter().enumerate() {
        text += &format!("{}, {:?}, {:?}, {:?}\n", node(n), p.x, p.y, p.z);
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
