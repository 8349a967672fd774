//! What a keyword file says, card by card.

use crate::cards::{Card, Fields, Line, TENS, cards, syntax, unsupported};
use crate::motion::{Damping, Motion, RigidLoad};
use mesh::import::ImportError;
use std::collections::BTreeMap;

/// The model of a keyword file, in its own units and numbers.
#[derive(Clone, Debug)]
pub(super) struct Deck {
    pub(super) nodes: Vec<Node>,
    pub(super) solids: Vec<Solid>,
    pub(super) parts: BTreeMap<u64, Part>,
    /// `ELFORM` of the sections, 1 or 2, by their number.
    pub(super) sections: BTreeMap<u64, i64>,
    pub(super) materials: BTreeMap<u64, Material>,
    /// `*HOURGLASS` by number; 0 stands for `*CONTROL_HOURGLASS`.
    pub(super) hourglass: BTreeMap<u64, Hourglass>,
    /// Quadratic and linear bulk viscosity of `*CONTROL_BULK_VISCOSITY`, Q1 and Q2.
    pub(super) bulk: [f64; 2],
    /// `SLSFAC`, the scale factor of penalty stiffness.
    pub(super) slsfac: f64,
    /// `TSSFAC`, the scale factor of the time step.
    pub(super) tssfac: f64,
    /// `ENDTIM`, the end time.
    pub(super) endtim: Option<f64>,
    pub(super) contact: Option<Contact>,
    pub(super) node_sets: BTreeMap<u64, Vec<u64>>,
    pub(super) segment_sets: BTreeMap<u64, Vec<[u64; 4]>>,
    /// Nodes that are held in x, y and z.
    pub(super) clamped: Vec<Target>,
    /// Nodes of the rigid hub.
    pub(super) hub: Option<Target>,
    /// The node of the rigid hub by which it is loaded, `PNODE`.
    pub(super) axle: Option<u64>,
    /// Nodes that are held in y alone.
    pub(super) sliding: Vec<Target>,
    /// Whether there are segments that do not reflect waves.
    pub(super) quiet: bool,
    pub(super) loads: Vec<Load>,
    pub(super) rigid_loads: Vec<RigidLoad>,
    pub(super) motions: Vec<Motion>,
    /// When the initial velocities are given.
    pub(super) begins: f64,
    pub(super) damping: Damping,
    /// Mass of the rigid hub with its nodes, where the file gives it.
    pub(super) hub_mass: Option<f64>,
    /// Intervals of the records of fields and of interface forces; 0 where there are none.
    pub(super) intervals: [f64; 2],
    pub(super) initial: Option<Initial>,
    /// Points of the curves, scaled and shifted as their cards say, by their number.
    pub(super) curves: BTreeMap<u64, Vec<[f64; 2]>>,
    /// Cards that were ignored, one sentence each.
    pub(super) notes: Vec<String>,
}

/// A node with its number, its line and its position.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub(super) id: u64,
    pub(super) line: usize,
    pub(super) point: [f64; 3],
}

/// A solid element with the numbers of its part and nodes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Solid {
    pub(super) id: u64,
    pub(super) part: u64,
    pub(super) line: usize,
    pub(super) nodes: [u64; 8],
}

/// The numbers of a part's section, material and hourglass card; 0 for no hourglass card.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    pub(super) section: u64,
    pub(super) material: u64,
    pub(super) hourglass: u64,
    pub(super) line: usize,
}

/// RO, E and PR of an elastic material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Material {
    pub(super) density: f64,
    pub(super) young: f64,
    pub(super) poisson: f64,
}

/// Hourglass control by stiffness.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hourglass {
    /// `QM`.
    pub(super) coefficient: f64,
    /// Q1 and Q2 where the card gives them.
    pub(super) bulk: Option<[f64; 2]>,
}

/// The contact card.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contact {
    pub(super) line: usize,
    /// Segment sets of both sides.
    pub(super) sides: [u64; 2],
    /// Coefficient of friction at rest.
    pub(super) fs: f64,
    /// Coefficient of friction at high slip velocity.
    pub(super) fd: f64,
    /// Decay of friction with slip velocity, in time over length.
    pub(super) dc: f64,
    /// Viscous damping in per cent of critical.
    pub(super) vdc: f64,
    /// `SFS` and `SFM`, which are equal.
    pub(super) sf: f64,
}

/// Nodes that a card acts on: a node set, or one node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Target {
    /// Whether `id` is the number of a set.
    pub(super) set: bool,
    pub(super) id: u64,
    pub(super) line: usize,
}

/// A force in z on each of the nodes: `factor` times a curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct Load {
    pub(super) on: Target,
    pub(super) curve: u64,
    pub(super) factor: f64,
}

/// The initial velocity.
#[derive(Clone, Copy, Debug)]
pub(super) struct Initial {
    pub(super) line: usize,
    /// Velocity in x.
    pub(super) speed: f64,
    /// Angular velocity about y, where the card gives it.
    pub(super) spin: Option<f64>,
}

/// Keywords that are ignored, with the reason for the notes: output, and what Creepage always does. One that ends in
/// `_` stands for all that begin with it.
const IGNORED: &[(&str, &str)] = &[
    ("KEYWORD", ""),
    ("TITLE", ""),
    ("CONTROL_ENERGY", "the energy of every part is always written"),
    ("CONTROL_OUTPUT", "output is the case's"),
    ("DATABASE_", "output is the case's"),
];

/// Those of them that are read all the same.
const READ: &[&str] = &["DATABASE_BINARY_D3PLOT", "DATABASE_BINARY_INTFOR"];

impl Deck {
    /// Reads a keyword file.
    ///
    /// # Errors
    /// What is not read, with its line.
    pub(super) fn read(bytes: &[u8]) -> Result<Self, ImportError> {
        let mut deck = Self {
            nodes: Vec::new(),
            solids: Vec::new(),
            parts: BTreeMap::new(),
            sections: BTreeMap::new(),
            materials: BTreeMap::new(),
            hourglass: BTreeMap::new(),
            // LS-DYNA's defaults
            bulk: [1.5, 0.06],
            slsfac: 0.1,
            tssfac: 0.9,
            endtim: None,
            contact: None,
            node_sets: BTreeMap::new(),
            segment_sets: BTreeMap::new(),
            clamped: Vec::new(),
            hub: None,
            axle: None,
            sliding: Vec::new(),
            quiet: false,
            loads: Vec::new(),
            rigid_loads: Vec::new(),
            motions: Vec::new(),
            begins: 0.0,
            damping: Damping::default(),
            hub_mass: None,
            intervals: [0.0; 2],
            initial: None,
            curves: BTreeMap::new(),
            notes: Vec::new(),
        };
        // loads refer to a node of the rigid hub
        let (hub, others): (Vec<_>, Vec<_>) = cards(bytes)?
            .into_iter()
            .partition(|card| card.name.starts_with("CONSTRAINED_NODAL_RIGID_BODY"));
        hub.iter().chain(&others).try_for_each(|card| deck.card(card))?;
        Ok(deck)
    }

    /// Takes a card into the model, ignores it or refuses it.
    fn card(&mut self, card: &Card) -> Result<(), ImportError> {
        let name = card.name.as_str();
        if self.motion_card(card)? {
            return Ok(());
        }
        if let Some((_, why)) = IGNORED.iter().find(|(word, _)| {
            let named = if word.ends_with('_') { name.starts_with(word) } else { name == *word };
            named && !READ.contains(&name)
        }) {
            if !why.is_empty() {
                self.notes.push(format!("line {}: *{name} is passed over: {why}", card.line));
            }
            return Ok(());
        }
        match name {
            "NODE" => self.nodes(card),
            "ELEMENT_SOLID" => self.solids(card),
            "PART" => self.part(card),
            "SECTION_SOLID" => self.section(card),
            "MAT_ELASTIC" | "MAT_001" => self.material(card),
            "HOURGLASS" => self.hourglass(card),
            "CONTROL_HOURGLASS" => {
                let fields = line(card, 0)?.fields(&TENS);
                let coefficient = stiffness_form(&fields, card, 0, 1)?;
                self.hourglass.insert(0, Hourglass { coefficient, bulk: None });
                Ok(())
            }
            "CONTROL_BULK_VISCOSITY" => {
                let fields = line(card, 0)?.fields(&TENS);
                self.bulk = [fields.real(0, 1.5)?, fields.real(1, 0.06)?];
                Ok(())
            }
            "CONTROL_CONTACT" => {
                self.slsfac = nonzero(line(card, 0)?.fields(&TENS).real(0, 0.1)?, 0.1);
                Ok(())
            }
            "CONTROL_TIMESTEP" => {
                let fields = line(card, 0)?.fields(&TENS);
                fields.unused(name, &[(4, "DT2MS"), (5, "LCTM")])?;
                self.tssfac = nonzero(fields.real(1, 0.9)?, 0.9);
                Ok(())
            }
            "CONTROL_TERMINATION" => {
                self.endtim = Some(line(card, 0)?.fields(&TENS).real(0, 0.0)?);
                Ok(())
            }
            "CONTACT_SURFACE_TO_SURFACE"
            | "CONTACT_AUTOMATIC_SURFACE_TO_SURFACE"
            | "CONTACT_SURFACE_TO_SURFACE_ID"
            | "CONTACT_AUTOMATIC_SURFACE_TO_SURFACE_ID" => self.contact(card),
            "SET_NODE" | "SET_NODE_LIST" => self.node_set(card),
            "SET_SEGMENT" => self.segment_set(card),
            "BOUNDARY_SPC_SET" | "BOUNDARY_SPC_NODE" => self.clamp(card, name.ends_with("SET")),
            "CONSTRAINED_NODAL_RIGID_BODY" | "CONSTRAINED_NODAL_RIGID_BODY_INERTIA" => {
                self.rigid_hub(card)
            }
            "LOAD_NODE_SET" | "LOAD_NODE_POINT" => self.load(card, name.ends_with("SET")),
            "INITIAL_VELOCITY" => {
                let fields = line(card, 1)?.fields(&TENS);
                let remaining = [(1, "VY"), (2, "VZ"), (3, "VXR"), (4, "VYR"), (5, "VZR")];
                fields.unused(name, &remaining)?;
                self.initial(card, fields.real(0, 0.0)?, None)
            }
            "INITIAL_VELOCITY_GENERATION" => {
                let fields = line(card, 0)?.fields(&TENS);
                fields.unused(name, &[(4, "VY"), (5, "VZ"), (6, "IVATN"), (7, "ICID")])?;
                let axis = line(card, 1)?.fields(&TENS);
                axis.unused(name, &[(3, "NX"), (5, "NZ"), (6, "PHASE")])?;
                let spin = fields.real(2, 0.0)? * axis.real(4, 0.0)?.signum();
                self.initial(card, fields.real(3, 0.0)?, Some(spin))
            }
            "DEFINE_CURVE" => self.curve(card),
            "DATABASE_BINARY_D3PLOT" => self.interval(card, 0),
            "DATABASE_BINARY_INTFOR" => self.interval(card, 1),
            _ if name.starts_with("INCLUDE") => {
                let remedy = "put the included lines into the file itself: without them the model \
                              lacks what they hold";
                Err(unsupported(card.line, format!("*{name}"), remedy))
            }
            _ => {
                let remedy = "leave the card out if the model does without it; the cards that are \
                              read: docs/ls-dyna.md";
                Err(unsupported(card.line, format!("*{name}"), remedy))
            }
        }
    }

    fn rigid_hub(&mut self, card: &Card) -> Result<(), ImportError> {
        let fields = line(card, 0)?.fields(&TENS);
        fields.unused(&card.name, &[(1, "CID")])?;
        self.axle = Some(fields.id(3)?).filter(|node| *node > 0);
        if card.name.ends_with("INERTIA") {
            let inertia = line(card, 1)?.fields(&TENS);
            inertia.unused(&card.name, &[(4, "IRCS")])?;
            self.hub_mass = Some(inertia.real(3, 0.0)?);
        }
        if let Some(before) = &self.hub {
            let what = format!("a second *{} after that of line {}", card.name, before.line);
            return Err(unsupported(card.line, what, "keep the hub of the disk alone"));
        }
        self.hub = Some(Target { set: true, id: fields.id(2)?, line: card.line });
        Ok(())
    }

    fn interval(&mut self, card: &Card, which: usize) -> Result<(), ImportError> {
        self.intervals[which] = line(card, 0)?.fields(&TENS).real(0, 0.0)?;
        Ok(())
    }

    fn nodes(&mut self, card: &Card) -> Result<(), ImportError> {
        for line in lines(card) {
            let fields = line.fields(&[8, 16, 16, 16, 8, 8]);
            fields.unused("NODE", &[(4, "TC"), (5, "RC")])?;
            let mut point = [0.0; 3];
            for (i, x) in point.iter_mut().enumerate() {
                *x = fields.real(1 + i, 0.0)?;
            }
            self.nodes.push(Node { id: fields.id(0)?, line: line.at, point });
        }
        Ok(())
    }

    /// Elements on one line, or number and part on one and the nodes on the next.
    fn solids(&mut self, card: &Card) -> Result<(), ImportError> {
        let mut lines = lines(card);
        while let Some(first) = lines.next() {
            let fields = first.fields(&[8; 10]);
            let (id, part) = (fields.id(0)?, fields.id(1)?);
            let (nodes, from) = if fields.id(2)? == 0 {
                let second = lines.next();
                (
                    second
                        .ok_or_else(|| syntax(first.at, "the nodes of the element are missing"))?,
                    0,
                )
            } else {
                (first, 2)
            };
            let fields = nodes.fields(&[8; 10]);
            let mut corners = [0; 8];
            for (i, corner) in corners.iter_mut().enumerate() {
                *corner = fields.id(from + i)?;
            }
            self.solids.push(Solid { id, part, line: first.at, nodes: corners });
        }
        Ok(())
    }

    /// Pairs of a heading line and a data line.
    fn part(&mut self, card: &Card) -> Result<(), ImportError> {
        for pair in card.data.chunks(2) {
            let [_, line] = pair else {
                return Err(syntax(card.line, "*PART needs a heading and a card"));
            };
            let fields = line.fields(&TENS);
            fields.unused("PART", &[(3, "EOSID"), (5, "GRAV"), (6, "ADPOPT"), (7, "TMID")])?;
            let (section, material, hourglass) = (fields.id(1)?, fields.id(2)?, fields.id(4)?);
            self.parts.insert(fields.id(0)?, Part { section, material, hourglass, line: line.at });
        }
        Ok(())
    }

    fn section(&mut self, card: &Card) -> Result<(), ImportError> {
        for line in lines(card) {
            let fields = line.fields(&TENS);
            let form = fields.whole(1)?;
            if !(0..=2).contains(&form) {
                let what = format!("*SECTION_SOLID with ELFORM = {form}");
                return Err(unsupported(line.at, what, "use ELFORM 1 (one point) or 2 (full)"));
            }
            self.sections.insert(fields.id(0)?, form.max(1));
        }
        Ok(())
    }

    fn material(&mut self, card: &Card) -> Result<(), ImportError> {
        for line in lines(card) {
            let fields = line.fields(&TENS);
            fields.unused("MAT_ELASTIC", &[(4, "DA"), (5, "DB")])?;
            let material = Material {
                density: fields.real(1, 0.0)?,
                young: fields.real(2, 0.0)?,
                poisson: fields.real(3, 0.0)?,
            };
            self.materials.insert(fields.id(0)?, material);
        }
        Ok(())
    }

    fn hourglass(&mut self, card: &Card) -> Result<(), ImportError> {
        for line in lines(card) {
            let fields = line.fields(&TENS);
            let coefficient = stiffness_form(&fields, card, 1, 2)?;
            let bulk = [nonzero(fields.real(4, 1.5)?, 1.5), nonzero(fields.real(5, 0.06)?, 0.06)];
            self.hourglass.insert(fields.id(0)?, Hourglass { coefficient, bulk: Some(bulk) });
        }
        Ok(())
    }

    fn contact(&mut self, card: &Card) -> Result<(), ImportError> {
        if let Some(before) = &self.contact {
            let what = format!("a second contact after that of line {}", before.line);
            return Err(unsupported(card.line, what, "keep that of disk and bar alone"));
        }
        let first = usize::from(card.name.ends_with("_ID"));
        let sides = line(card, first)?;
        let fields = sides.fields(&TENS);
        if fields.whole(2)? != 0 || fields.whole(3)? != 0 {
            let what = "a contact between parts (SSTYP, MSTYP other than 0)";
            let remedy = "give both surfaces as *SET_SEGMENT: tread and top";
            return Err(unsupported(sides.at, what, remedy));
        }
        fields.unused("CONTACT", &[(4, "SBOXID"), (5, "MBOXID")])?;
        let friction = line(card, first + 1)?.fields(&TENS);
        friction.unused("CONTACT", &[(3, "VC"), (6, "BT")])?;
        let scales = match card.data.get(first + 2) {
            None => [1.0; 2],
            Some(line) => {
                let fields = line.fields(&TENS);
                fields.unused("CONTACT", &[(2, "SST"), (3, "MST")])?;
                for (i, name) in [(4, "SFST"), (5, "SFMT"), (6, "FSF"), (7, "VSF")] {
                    let x = fields.real(i, 1.0)?;
                    if x != 1.0 && x != 0.0 {
                        let what = format!("*CONTACT with {name} = {x}");
                        return Err(unsupported(line.at, what, "leave the field blank or 1"));
                    }
                }
                [nonzero(fields.real(0, 1.0)?, 1.0), nonzero(fields.real(1, 1.0)?, 1.0)]
            }
        };
        if scales[0] != scales[1] {
            let what = format!("*CONTACT with SFS = {} and SFM = {}", scales[0], scales[1]);
            return Err(unsupported(card.line, what, "give both one value: both passes are alike"));
        }
        if let Some(optional) = card.data.get(first + 3) {
            let soft = optional.fields(&TENS).whole(0)?;
            if soft != 0 {
                let what = format!("*CONTACT with SOFT = {soft}");
                return Err(unsupported(optional.at, what, "use SOFT = 0"));
            }
        }
        self.contact = Some(Contact {
            line: card.line,
            sides: [fields.id(0)?, fields.id(1)?],
            fs: friction.real(0, 0.0)?,
            fd: friction.real(1, 0.0)?,
            dc: friction.real(2, 0.0)?,
            vdc: friction.real(4, 0.0)?,
            sf: scales[0],
        });
        Ok(())
    }

    fn initial(&mut self, card: &Card, speed: f64, spin: Option<f64>) -> Result<(), ImportError> {
        let mut further = card.data.iter().skip(2).filter(|line| !line.text.trim().is_empty());
        let further = further.next().map(|line| (line.at, card.line));
        let second = self.initial.map(|before| (card.line, before.line));
        if let Some((at, before)) = further.or(second) {
            let what =
                format!("a further line or a second initial velocity after that of line {before}");
            return Err(unsupported(at, what, "keep that of the disk alone"));
        }
        self.initial = Some(Initial { line: card.line, speed, spin });
        Ok(())
    }

    fn node_set(&mut self, card: &Card) -> Result<(), ImportError> {
        let id = line(card, 0)?.fields(&TENS).id(0)?;
        let set = self.node_sets.entry(id).or_default();
        for line in &card.data[1..] {
            let fields = line.fields(&TENS);
            for i in 0..8 {
                let node = fields.id(i)?;
                if node > 0 {
                    set.push(node);
                }
            }
        }
        Ok(())
    }

    fn segment_set(&mut self, card: &Card) -> Result<(), ImportError> {
        let id = line(card, 0)?.fields(&TENS).id(0)?;
        let set = self.segment_sets.entry(id).or_default();
        for line in card.data[1..].iter().filter(|l| !l.text.trim().is_empty()) {
            let fields = line.fields(&TENS);
            let nodes = [fields.id(0)?, fields.id(1)?, fields.id(2)?, fields.id(3)?];
            set.push(nodes);
        }
        Ok(())
    }

    fn clamp(&mut self, card: &Card, set: bool) -> Result<(), ImportError> {
        for line in lines(card) {
            let fields = line.fields(&TENS);
            let fixed = [fields.whole(2)?, fields.whole(3)?, fields.whole(4)?];
            let target = Target { set, id: fields.id(0)?, line: line.at };
            if fields.whole(1)? == 0 && fixed == [0, 1, 0] {
                self.sliding.push(target);
                continue;
            }
            if fields.whole(1)? != 0 || fixed != [1; 3] {
                let what = format!("*{} with DOFX, DOFY, DOFZ = {fixed:?}", card.name);
                let remedy = "clamp the bar in x, y and z, and hold a plane of symmetry in y alone, in the global system";
                return Err(unsupported(line.at, what, remedy));
            }
            self.clamped.push(target);
        }
        Ok(())
    }

    fn load(&mut self, card: &Card, set: bool) -> Result<(), ImportError> {
        for line in lines(card) {
            let fields = line.fields(&TENS);
            fields.unused(&card.name, &[(4, "CID")])?;
            let dof = fields.whole(1)?;
            let on = Target { set, id: fields.id(0)?, line: line.at };
            let (curve, factor) = (fields.id(2)?, nonzero(fields.real(3, 1.0)?, 1.0));
            let axle = !set && self.axle == Some(on.id);
            if !(dof == 3 || axle && dof == 6) {
                let what = format!("*{} with DOF = {dof}", card.name);
                let remedy =
                    "load the hub in z (DOF = 3), and turn it about y (DOF = 6) at its PNODE";
                return Err(unsupported(line.at, what, remedy));
            }
            if axle {
                self.rigid_loads.push(RigidLoad { line: line.at, dof, curve, factor });
            } else {
                self.loads.push(Load { on, curve, factor });
            }
        }
        Ok(())
    }

    fn curve(&mut self, card: &Card) -> Result<(), ImportError> {
        let fields = line(card, 0)?.fields(&TENS);
        let scale = |i: usize| fields.real(i, 1.0).map(|x| nonzero(x, 1.0));
        let ([sfa, sfo], [offa, offo]) =
            ([scale(2)?, scale(3)?], [fields.real(4, 0.0)?, fields.real(5, 0.0)?]);
        let mut points = Vec::new();
        for line in card.data[1..].iter().filter(|l| !l.text.trim().is_empty()) {
            let fields = line.fields(&[20; 4]);
            points.push([sfa * (fields.real(0, 0.0)? + offa), sfo * (fields.real(1, 0.0)? + offo)]);
        }
        self.curves.insert(fields.id(0)?, points);
        Ok(())
    }
}

/// The default for a field of 0, as LS-DYNA takes it.
pub(super) fn nonzero(x: f64, default: f64) -> f64 {
    if x == 0.0 { default } else { x }
}

/// QM of the stiffness forms of Flanagan and Belytschko, IHQ 4 and 5.
fn stiffness_form(fields: &Fields, card: &Card, ihq: usize, qm: usize) -> Result<f64, ImportError> {
    let form = fields.whole(ihq)?;
    if form != 4 && form != 5 {
        let what = format!("*{} with IHQ = {form}", card.name);
        let remedy = "use IHQ 4 or 5: hourglass modes are held by stiffness";
        return Err(unsupported(card.line, what, remedy));
    }
    Ok(nonzero(fields.real(qm, 0.1)?, 0.1))
}

/// The data lines of a card that are not blank.
pub(super) fn lines<'a>(card: &Card<'a>) -> impl Iterator<Item = Line<'a>> + use<'a> {
    card.data.clone().into_iter().filter(|line| !line.text.trim().is_empty())
}

/// Data line `i` of a card, counted from 0.
pub(super) fn line<'a>(card: &Card<'a>, i: usize) -> Result<Line<'a>, ImportError> {
    let missing = || syntax(card.line, format!("data line {} of *{} is missing", i + 1, card.name));
    card.data.get(i).copied().ok_or_else(missing)
}
