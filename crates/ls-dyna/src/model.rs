//! From the cards to a case and its mesh.

use crate::cards::{syntax, unsupported};
use crate::deck::{Deck, Target};
use crate::units::Units;
use mesh::import::{Fault, Foreign, ImportError, Labels, Set, write_abaqus};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::fmt::Write as _;
use toml::Value;

/// A keyword file as Creepage takes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Translation {
    /// The case file.
    pub case: String,
    /// The mesh file, an Abaqus input file in metres with the nodes' and elements' own numbers.
    pub mesh: String,
    /// What was passed over or decided, a sentence each.
    pub notes: Vec<String>,
}

/// Translates a keyword file; `title` names it, `mesh_file` is the mesh file's name in the case.
///
/// # Errors
/// What is not read, by its line, and what a disk on a bar lacks.
pub fn translate(
    bytes: &[u8],
    units: Units,
    title: &str,
    mesh_file: &str,
) -> Result<Translation, ImportError> {
    let deck = Deck::read(bytes)?;
    let mut notes = deck.notes.clone();
    let mut model = Model::new(&deck, units)?;
    let shape = model.place(&mut notes);
    let case = case(&deck, &model, &shape, units, title, mesh_file, &mut notes)?;
    Ok(Translation { case, mesh: write_abaqus(&model.foreign), notes })
}

/// The mesh of the disk and the bar with its sets.
struct Model {
    foreign: Foreign,
    /// The parts of disk and bar.
    parts: [u64; 2],
    /// Nodes of the two bodies.
    nodes: [BTreeSet<u32>; 2],
}

/// Shapes that the case gives, measured on the mesh (m).
struct Shape {
    radius: f64,
    hub_radius: f64,
    disk_width: f64,
    disk_crown: Option<f64>,
    length: f64,
    bar_width: f64,
    height: f64,
    bar_crown: Option<f64>,
    start: f64,
    zone: Zone,
}

/// The fine part of the bar's top.
struct Zone {
    size: f64,
    start: f64,
    length: f64,
    width: f64,
}

fn lacks(what: &str) -> ImportError {
    ImportError { line: None, fault: Fault::Syntax { what: format!("the file has no {what}") } }
}

impl Model {
    fn new(deck: &Deck, units: Units) -> Result<Self, ImportError> {
        let mut places: HashMap<u64, u32> = HashMap::new();
        let mut foreign = Foreign::default();
        for node in &deck.nodes {
            if places.insert(node.id, foreign.points.len() as u32).is_some() {
                let fault = Fault::Repeated { what: "node", id: node.id };
                return Err(ImportError { line: Some(node.line), fault });
            }
            foreign.points.push(node.point.map(|x| x * units.length()));
            label(&mut foreign.nodes, node.id, node.line);
        }
        let find = |from: &str, node: u64, line: usize| {
            let fault = || Fault::Unknown { from: from.into(), what: format!("node {node}") };
            places
                .get(&node)
                .copied()
                .ok_or_else(|| ImportError { line: Some(line), fault: fault() })
        };
        for solid in &deck.solids {
            let mut hex = [0; 8];
            for (corner, &node) in hex.iter_mut().zip(&solid.nodes) {
                *corner = find(&format!("element {}", solid.id), node, solid.line)?;
            }
            foreign.hexes.push(hex);
            label(&mut foreign.elements, solid.id, solid.line);
        }
        let of = |target: &Target| -> Result<Vec<u32>, ImportError> {
            let ids = match deck.node_sets.get(&target.id) {
                _ if !target.set => vec![target.id],
                Some(ids) => ids.clone(),
                None => {
                    let (from, what) = ("the card".into(), format!("node set {}", target.id));
                    let fault = Fault::Unknown { from, what };
                    return Err(ImportError { line: Some(target.line), fault });
                }
            };
            ids.iter().map(|&id| find("the card", id, target.line)).collect()
        };
        let hub = deck.hub.as_ref().ok_or_else(|| {
            lacks("*CONSTRAINED_NODAL_RIGID_BODY, whose node set is the rigid hub of the disk")
        })?;
        let hub = of(hub)?;
        let parts: BTreeSet<u64> = deck.solids.iter().map(|s| s.part).collect();
        let held: BTreeSet<u32> = hub.iter().copied().collect();
        let on_hub = |e: usize| foreign.hexes[e].iter().any(|n| held.contains(n));
        let disk = (0..foreign.hexes.len()).find(|&e| on_hub(e)).map(|e| deck.solids[e].part);
        let disk = disk.ok_or_else(|| lacks("solid elements on the nodes of the rigid hub"))?;
        let others: Vec<u64> = parts.into_iter().filter(|p| *p != disk).collect();
        let [bar] = others[..] else {
            let what = format!("a model of {} parts of solids", others.len() + 1);
            let remedy = "keep one part for the disk and one for the bar";
            return Err(unsupported(deck.solids[0].line, what, remedy));
        };
        let parts = [disk, bar];
        let mut nodes = [BTreeSet::new(), BTreeSet::new()];
        let mut sets: BTreeMap<String, Set> = BTreeMap::new();
        for (e, solid) in deck.solids.iter().enumerate() {
            let body = usize::from(solid.part == bar);
            nodes[body].extend(foreign.hexes[e]);
            let name = ["disk", "bar"][body].to_owned();
            sets.entry(name).or_default().hexes.push(e as u32);
        }
        sets.entry("hub".into()).or_default().nodes = hub;
        for target in &deck.clamped {
            sets.entry("clamp".into()).or_default().nodes.extend(of(target)?);
        }
        if deck.clamped.is_empty() {
            return Err(lacks("*BOUNDARY_SPC_SET that clamps the bar"));
        }
        let contact = deck.contact.ok_or_else(|| lacks("*CONTACT_SURFACE_TO_SURFACE"))?;
        for side in contact.sides {
            let segments = deck.segment_sets.get(&side).ok_or_else(|| {
                let (from, what) = ("the contact".into(), format!("segment set {side}"));
                ImportError { line: Some(contact.line), fault: Fault::Unknown { from, what } }
            })?;
            if segments.is_empty() {
                return Err(syntax(contact.line, format!("segment set {side} has no segments")));
            }
            let mut faces = Vec::new();
            for segment in segments {
                let mut face = [0; 4];
                for (corner, &node) in face.iter_mut().zip(segment) {
                    *corner = find(&format!("segment set {side}"), node, contact.line)?;
                }
                faces.push(face);
            }
            let on_disk = nodes[0].contains(&faces[0][0]);
            let name = if on_disk { "tread" } else { "top" };
            if sets.insert(name.into(), Set { faces, ..Set::default() }).is_some() {
                let what = "the two surfaces of the contact lie on one body";
                return Err(syntax(contact.line, what));
            }
        }
        foreign.sets = sets;
        Ok(Self { foreign, parts, nodes })
    }

    fn extent(&self, nodes: &mut dyn Iterator<Item = u32>) -> [[f64; 2]; 3] {
        let mut extent = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
        for n in nodes {
            for (a, [low, high]) in extent.iter_mut().enumerate() {
                let x = self.foreign.points[n as usize][a];
                (*low, *high) = (low.min(x), high.max(x));
            }
        }
        extent
    }

    fn faces(&self, set: &str) -> &[[u32; 4]] {
        self.foreign.sets.get(set).map_or(&[], |set| &set.faces)
    }

    /// Moves the bodies to where Creepage wants them: the disk's axis at x = 0, the bar's apex at
    /// z = 0 and the disk on it, both centred on y = 0. Measures their shapes.
    fn place(&mut self, notes: &mut Vec<String>) -> Shape {
        let top = self.extent(&mut self.faces("top").iter().flatten().copied());
        let bodies = [0, 1].map(|b| self.extent(&mut self.nodes[b].iter().copied()));
        let middle = |[low, high]: [f64; 2]| 0.5 * (low + high);
        let across = middle(bodies[0][1]);
        let ([axis, height], radius) = self.running_circle(across);
        let lowest = height - radius;
        let drop = lowest - top[2][1];
        let moves = [[-axis, -across, -lowest], [-axis, -middle(bodies[1][1]), -top[2][1]]];
        for (body, by) in moves.iter().enumerate() {
            for &n in &self.nodes[body] {
                let point = &mut self.foreign.points[n as usize];
                (0..3).for_each(|a| point[a] += by[a]);
            }
        }
        if drop.abs() > 1e-9 {
            notes.push(format!("the disk is moved by {:.3e} m in z, to touch the bar", -drop));
        }
        if axis.abs() > 1e-9 {
            notes.push(format!(
                "both bodies are moved by {:.6} m in x: rolling starts at x = 0",
                -axis
            ));
        }
        let [disk, bar] = [0, 1].map(|b| self.extent(&mut self.nodes[b].iter().copied()));
        let span = |[low, high]: [f64; 2]| high - low;
        let points = &self.foreign.points;
        let from_axis = |n: u32| {
            let p = points[n as usize];
            libm::hypot(p[0], p[2] - radius)
        };
        let hub = self.foreign.sets["hub"].nodes.iter().map(|&n| from_axis(n));
        let rim: Vec<[f64; 2]> = self
            .faces("tread")
            .iter()
            .flatten()
            .map(|&n| [points[n as usize][1], radius - from_axis(n)])
            .collect();
        let head: Vec<[f64; 2]> = self
            .faces("top")
            .iter()
            .flatten()
            .map(|&n| [points[n as usize][1], -points[n as usize][2]])
            .collect();
        Shape {
            radius,
            hub_radius: hub.fold(0.0, f64::max),
            disk_width: span(disk[1]),
            disk_crown: crown(&rim),
            length: span(bar[0]),
            bar_width: span(bar[1]),
            height: -bar[2][0],
            bar_crown: crown(&head),
            start: bar[0][0],
            zone: self.zone(bar[0], span(bar[1]).min(span(disk[1]))),
        }
    }

    /// Centre (x, z) and radius of the circle through the tread's nodes nearest to y = `across`.
    ///
    /// Source: Kåsa (1976), "A circle fitting procedure and its error analysis": the linear least
    /// squares of x^2 + z^2 = 2 a x + 2 b z + c.
    fn running_circle(&self, across: f64) -> ([f64; 2], f64) {
        let nodes: BTreeSet<u32> = self.faces("tread").iter().flatten().copied().collect();
        let at = |n: u32| self.foreign.points[n as usize];
        let off = |n: u32| (at(n)[1] - across).abs();
        let least = nodes.iter().map(|&n| off(n)).fold(f64::INFINITY, f64::min);
        let ring: Vec<[f64; 2]> = nodes
            .iter()
            .filter(|n| off(**n) <= least + 1e-6)
            .map(|&n| [at(n)[0], at(n)[2]])
            .collect();
        let count = ring.len() as f64;
        let mean = [0, 1].map(|i| ring.iter().map(|p| p[i]).sum::<f64>() / count);
        let (mut xx, mut xz, mut zz, mut xr, mut zr, mut rr) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        for p in &ring {
            let (x, z) = (p[0] - mean[0], p[1] - mean[1]);
            let r = x * x + z * z;
            (xx, xz, zz) = (xx + x * x, xz + x * z, zz + z * z);
            (xr, zr, rr) = (xr + x * r, zr + z * r, rr + r);
        }
        let twice = 2.0 * (xx * zz - xz * xz);
        let (a, b) = ((xr * zz - zr * xz) / twice, (zr * xx - xr * xz) / twice);
        ([mean[0] + a, mean[1] + b], (rr / count + a * a + b * b).sqrt())
    }

    /// The part of the bar's top with faces about as small as that nearest to the first contact, on
    /// the bar from `ends[0]` to `ends[1]` and no wider than `width`.
    fn zone(&self, ends: [f64; 2], width: f64) -> Zone {
        let points = &self.foreign.points;
        let faces: Vec<([f64; 2], f64)> = self
            .faces("top")
            .iter()
            .map(|face| {
                let corners = face.map(|n| points[n as usize]);
                let at = |a: usize| 0.25 * corners.iter().map(|p| p[a]).sum::<f64>();
                let area: f64 = mesh::quad_corner_areas(&corners).iter().sum();
                ([at(0), at(1)], area.sqrt())
            })
            .collect();
        let distance = |f: &&([f64; 2], f64)| libm::hypot(f.0[0], f.0[1]);
        let nearest = faces.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let size = nearest.map_or(1e-3, |f| f.1);
        let (mut x, mut y) = ([0.0f64; 2], 0.0f64);
        for (at, edge) in &faces {
            if (0.7..1.3).contains(&(edge / size)) {
                x = [x[0].min(at[0] - 0.5 * size), x[1].max(at[0] + 0.5 * size)];
                y = y.max(at[1].abs() + 0.5 * size);
            }
        }
        let x = [x[0].max(ends[0]), x[1].min(ends[1])];
        Zone { size, start: x[0], length: x[1] - x[0], width: width.min(2.0 * y) }
    }
}

fn label(labels: &mut Labels, id: u64, line: usize) {
    labels.ids.push(id);
    labels.lines.push(line);
}

/// Radius of the crown from (y, depth below the apex): that through its outermost points.
fn crown(profile: &[[f64; 2]]) -> Option<f64> {
    let widest = profile.iter().map(|p| p[0].abs()).fold(0.0, f64::max);
    let rim: Vec<_> = profile.iter().filter(|p| p[0].abs() > 0.999 * widest).collect();
    let sag = rim.iter().map(|p| p[1]).sum::<f64>() / rim.len().max(1) as f64;
    (sag > 1e-5 * widest).then(|| (widest * widest + sag * sag) / (2.0 * sag))
}

/// Six digits, as a person would write them.
fn six(x: f64) -> String {
    case::key::number(format!("{x:.5e}").parse().unwrap_or(x))
}

/// The case file.
fn case(
    deck: &Deck,
    model: &Model,
    shape: &Shape,
    units: Units,
    title: &str,
    mesh_file: &str,
    notes: &mut Vec<String>,
) -> Result<String, ImportError> {
    let contact = deck.contact.ok_or_else(|| lacks("contact"))?;
    let speed = deck.speed.filter(|v| *v > 0.0).ok_or_else(|| {
        lacks(
            "*INITIAL_VELOCITY or *INITIAL_VELOCITY_GENERATION with VX above 0: the rolling speed",
        )
    })?;
    let speed = speed * units.velocity();
    let creepage = match deck.spin {
        Some(spin) => spin / units.time() * shape.radius / speed - 1.0,
        None => {
            notes.push("no angular velocity is given: drive.creepage = 0, change it".into());
            0.0
        }
    };
    let normal = load(deck, model, units)?;
    let end = deck.endtim.filter(|t| *t > 0.0).ok_or_else(|| lacks("*CONTROL_TERMINATION"))?;
    let mut materials = Vec::new();
    let (mut full, mut hourglass, mut bulk) = (Vec::new(), Vec::new(), Vec::new());
    for part in model.parts {
        let unknown = |what: &str, id: u64, line: usize| {
            let fault =
                Fault::Unknown { from: format!("part {part}"), what: format!("{what} {id}") };
            ImportError { line: Some(line), fault }
        };
        let card = deck.parts.get(&part).ok_or_else(|| lacks(&format!("*PART {part}")))?;
        let material = deck.materials.get(&card.material);
        materials.push(*material.ok_or_else(|| unknown("material", card.material, card.line))?);
        let form = deck.sections.get(&card.section);
        full.push(*form.ok_or_else(|| unknown("section", card.section, card.line))? == 2);
        let held = match (card.hourglass, deck.hourglass.get(&card.hourglass)) {
            (0, held) => held,
            (id, None) => return Err(unknown("hourglass", id, card.line)),
            (_, held) => held,
        };
        hourglass.push(held.map(|h| h.coefficient));
        bulk.push(held.and_then(|h| h.bulk).unwrap_or(deck.bulk));
    }
    for (what, alike) in [
        ("the formulation of their elements", full[0] == full[1]),
        ("their hourglass control", hourglass[0] == hourglass[1]),
        ("their bulk viscosity", bulk[0] == bulk[1]),
    ] {
        if !alike {
            let line = deck.parts[&model.parts[1]].line;
            let what = format!("a disk and a bar that differ in {what}");
            return Err(unsupported(line, what, "give both parts the same"));
        }
    }

    let Shape { zone, .. } = shape;
    let crown = |crown: Option<f64>| crown.map_or("\"flat\"".into(), six);
    let mut t = String::new();
    // writing to a String cannot fail
    let mut say = |line: String| _ = writeln!(t, "{line}");
    // a comment ends with its line
    let name = title.replace(char::is_control, " ");
    say(format!(
        "# From {name} by `creepage import-k`; SI units. docs/ls-dyna.md says what became of each card."
    ));
    say(format!("\ntitle = {}", Value::String(format!("from {title}"))));
    say("\n[disk]                    # measured on the mesh".into());
    say(format!("radius = {}\nhub_radius = {}", six(shape.radius), six(shape.hub_radius)));
    say(format!("width = {}\ncrown_radius = {}", six(shape.disk_width), crown(shape.disk_crown)));
    say("\n[bar]                     # measured on the mesh".into());
    say(format!("length = {}\nwidth = {}", six(shape.length), six(shape.bar_width)));
    say(format!("height = {}\ncrown_radius = {}", six(shape.height), crown(shape.bar_crown)));
    say(format!("start = {}", six(shape.start)));
    say("ends = \"free\"             # LS-DYNA's are, without *BOUNDARY_NON_REFLECTING".into());
    say(format!("\n[mesh]\nfile = {mesh_file:?}"));
    say("\n[mesh.zone]               # the fine part of the bar's top".into());
    say(format!("size = {}\nstart = {}", six(zone.size), six(zone.start)));
    say(format!("length = {}\nwidth = {}", six(zone.length), six(zone.width)));
    for (body, material) in ["disk", "bar"].iter().zip(&materials) {
        say(format!("\n[{body}.material]          # *MAT_ELASTIC: E, PR, RO"));
        say(format!(
            "young = {}\npoisson = {}",
            six(material.young * units.stress()),
            six(material.poisson)
        ));
        say(format!("density = {}", six(material.density * units.density())));
    }
    say(format!(
        "\n[load]\nnormal = {}              # *LOAD_NODE times its curve at the end",
        six(normal)
    ));
    say(format!("\n[drive]\nspeed = {}              # VX", six(speed)));
    say(format!("creepage = {}           # OMEGA R/VX - 1", six(creepage)));
    say("\n[friction]                # FD + (FS - FD) exp(-DC v)".into());
    let falls = contact.dc != 0.0 && contact.fd != contact.fs;
    say(format!("law = {:?}", if falls { "exponential" } else { "coulomb" }));
    say(format!("static = {}", six(contact.fs)));
    if falls {
        say(format!("dynamic = {}", six(contact.fd)));
        say(format!("decay = {}", six(contact.dc / units.velocity())));
    }
    say("\n[contact]\ncurvature = false         # LS-DYNA's contact meets the facets".into());
    let factor = six(deck.slsfac * contact.sf);
    say(format!(
        "\n[contact.penalty]         # SLSFAC times SFS\nnormal = {factor}\ntangential = {factor}"
    ));
    say(format!("damping = {}              # VDC/100", six(contact.vdc / 100.0)));
    say("\n[element]".into());
    match hourglass[0] {
        Some(coefficient) => say(format!("hourglass = {}          # QM", six(coefficient))),
        None => notes.push(
            "no *HOURGLASS: LS-DYNA's default is viscous (IHQ 1), the case holds hourglass modes by \
             stiffness, element.hourglass = 0.05"
                .into(),
        ),
    }
    if full[0] {
        say("contact_layers = \"full\"   # ELFORM 2".into());
        notes.push(
            "ELFORM 2: the two layers of elements below the contact are fully integrated, the others \
             have one point"
                .into(),
        );
    } else {
        say("contact_layers = \"one-point\"   # ELFORM 1".into());
    }
    say("\n[damping]                 # Q2 and Q1".into());
    say(format!("bulk_linear = {}\nbulk_quadratic = {}", six(bulk[0][1]), six(bulk[0][0])));
    say(format!("\n[time]\nfactor = {}             # TSSFAC", six(deck.tssfac)));
    say(format!("duration = {}          # ENDTIM", six(end * units.time())));
    Ok(t)
}

/// The force that presses the disk down (N): the sum over the loaded nodes, by their curves' last
/// values.
fn load(deck: &Deck, model: &Model, units: Units) -> Result<f64, ImportError> {
    let mut sum = 0.0;
    let places: HashMap<u64, u32> =
        model.foreign.nodes.ids.iter().zip(0..).map(|(id, place)| (*id, place)).collect();
    for load in &deck.loads {
        let unknown = |what: String| {
            let fault = Fault::Unknown { from: "the load".into(), what };
            ImportError { line: Some(load.on.line), fault }
        };
        let nodes = if load.on.set {
            let set = deck.node_sets.get(&load.on.id);
            set.cloned().ok_or_else(|| unknown(format!("node set {}", load.on.id)))?
        } else {
            vec![load.on.id]
        };
        let on_disk = |id: &u64| places.get(id).is_some_and(|n| model.nodes[0].contains(n));
        if let Some(id) = nodes.iter().find(|id| !on_disk(id)) {
            return Err(unknown(format!("node {id}, which is none of the disk's")));
        }
        let curve = deck.curves.get(&load.curve).and_then(|points| points.last());
        let [_, last] = *curve.ok_or_else(|| unknown(format!("curve {}", load.curve)))?;
        sum += load.factor * last * nodes.len() as f64;
    }
    if sum >= 0.0 {
        return Err(lacks("*LOAD_NODE_SET that presses the disk down, in -z"));
    }
    Ok(-sum * units.force())
}
