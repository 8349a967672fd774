//! What a keyword file says, card by card.

use crate::cards::{Card, Fields, TENS};
use crate::error::{DeckError, Place, second, syntax, unsupported};
use crate::motion::{Damping, Motion, RigidLoad};
use crate::unread;
use std::collections::BTreeMap;

/// The model of a keyword file, in its own units and numbers.
#[derive(Clone, Debug, Default)]
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
    pub(super) part_sets: BTreeMap<u64, Vec<u64>>,
    /// Nodes that are held in x, y and z.
    pub(super) clamped: Vec<Target>,
    /// Nodes of the rigid hub.
    pub(super) hub: Option<Target>,
    /// Its number as a part, `PID`.
    pub(super) hub_part: u64,
    /// The node of the rigid hub by which it is loaded, `PNODE`.
    pub(super) axle: Option<u64>,
    /// Nodes that are held in y alone.
    pub(super) sliding: Vec<Target>,
    /// Segment sets that do not reflect waves.
    pub(super) quiet: Vec<Target>,
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
    /// Keywords that were passed over, each once.
    pub(super) passed_over: Vec<String>,
}

/// A node with its number, its line and its position.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub(super) id: u64,
    pub(super) place: Place,
    pub(super) point: [f64; 3],
}

/// A solid element with the numbers of its part and nodes.
#[derive(Clone, Debug)]
pub(super) struct Solid {
    pub(super) id: u64,
    pub(super) part: u64,
    pub(super) place: Place,
    pub(super) nodes: [u64; 8],
}

/// The numbers of a part's section, material and hourglass card; 0 for no hourglass card.
#[derive(Clone, Debug)]
pub(super) struct Part {
    pub(super) section: u64,
    pub(super) material: u64,
    pub(super) hourglass: u64,
    pub(super) place: Place,
}

/// RO, E and PR of an elastic material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Material {
    pub(super) density: f64,
    pub(super) young: f64,
    pub(super) poisson: f64,
}

/// Hourglass control by stiffness.
#[derive(Clone, Debug)]
pub(super) struct Hourglass {
    /// `QM`.
    pub(super) coefficient: f64,
    /// Q1 and Q2 where the card gives them.
    pub(super) bulk: Option<[f64; 2]>,
}

/// The contact card.
#[derive(Clone, Debug)]
pub(super) struct Contact {
    pub(super) place: Place,
    pub(super) sides: [Side; 2],
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

/// What makes up a side of the contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Side {
    /// The segments of a set.
    Segments(u64),
    /// The outer faces of a part.
    Part(u64),
    /// The outer faces of the parts of a set.
    PartSet(u64),
}

/// Nodes that a card acts on: a node set, or one node.
#[derive(Clone, Debug)]
pub(super) struct Target {
    /// Whether `id` is the number of a set.
    pub(super) set: bool,
    pub(super) id: u64,
    pub(super) place: Place,
}

/// A force in z on each of the nodes: `factor` times a curve.
#[derive(Clone, Debug)]
pub(super) struct Load {
    pub(super) on: Target,
    pub(super) curve: u64,
    pub(super) factor: f64,
}

/// The initial velocity.
#[derive(Clone, Debug)]
pub(super) struct Initial {
    pub(super) place: Place,
    /// Velocity in x.
    pub(super) speed: f64,
    /// Angular velocity about y, where the card gives it.
    pub(super) spin: Option<f64>,
    /// `STYP` and the number of the part, part set or node set that has the velocity; `None` for all nodes' card.
    pub(super) of: Option<(i64, u64)>,
}

impl Deck {
    /// Takes the cards of a deck.
    ///
    /// # Errors
    /// What is not read, with its line.
    pub(super) fn read(cards: Vec<Card>) -> Result<Self, DeckError> {
        // LS-DYNA's defaults
        let mut deck = Self { bulk: [1.5, 0.06], slsfac: 0.1, tssfac: 0.9, ..Self::default() };
        // loads refer to a node of the rigid hub
        let (hub, others): (Vec<_>, Vec<_>) = cards
            .into_iter()
            .partition(|card| card.name.starts_with("CONSTRAINED_NODAL_RIGID_BODY"));
        hub.iter().chain(&others).try_for_each(|card| deck.card(card))?;
        Ok(deck)
    }

    /// Takes a card into the model, passes it over or refuses it.
    fn card(&mut self, card: &Card) -> Result<(), DeckError> {
        if self.mesh_card(card)?
            || self.set_card(card)?
            || self.control_card(card)?
            || self.motion_card(card)?
        {
            return Ok(());
        }
        if !unread::passed_over(card)? {
            return Err(unread::refused(card));
        }
        let name = format!("*{}", card.name);
        if !unread::unremarkable(&card.name) && !self.passed_over.contains(&name) {
            self.passed_over.push(name);
        }
        Ok(())
    }

    /// Takes a card of the mesh, its materials and its contact; whether it is one.
    fn mesh_card(&mut self, card: &Card) -> Result<bool, DeckError> {
        match card.name.as_str() {
            "NODE" => self.nodes(card)?,
            "ELEMENT_SOLID" => self.solids(card)?,
            "PART" => self.part(card)?,
            "SECTION_SOLID" => self.section(card)?,
            "MAT_ELASTIC" | "MAT_001" => self.material(card)?,
            "HOURGLASS" => self.hourglass(card)?,
            "CONTACT_SURFACE_TO_SURFACE" | "CONTACT_AUTOMATIC_SURFACE_TO_SURFACE" => {
                self.contact(card)?;
            }
            "CONSTRAINED_NODAL_RIGID_BODY" | "CONSTRAINED_NODAL_RIGID_BODY_INERTIA" => {
                self.rigid_hub(card)?;
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// Takes a set, or a card that acts on one; whether it is one.
    fn set_card(&mut self, card: &Card) -> Result<bool, DeckError> {
        let of_set = card.name.ends_with("SET");
        match card.name.as_str() {
            "SET_NODE" | "SET_NODE_LIST" => {
                let (id, nodes) = members(card)?;
                self.node_sets.entry(id).or_default().extend(nodes);
            }
            "SET_PART" | "SET_PART_LIST" => {
                let (id, parts) = members(card)?;
                self.part_sets.entry(id).or_default().extend(parts);
            }
            "SET_SEGMENT" => self.segment_set(card)?,
            "BOUNDARY_SPC_SET" | "BOUNDARY_SPC_NODE" => self.clamp(card, of_set)?,
            "BOUNDARY_NON_REFLECTING" => {
                for line in card.lines() {
                    let id = line.fields(&TENS).id(0)?;
                    self.quiet.push(Target { set: true, id, place: line.place() });
                }
            }
            "LOAD_NODE_SET" | "LOAD_NODE_POINT" => self.load(card, of_set)?,
            "DEFINE_CURVE" => self.curve(card)?,
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// Takes a card of the method or of output; whether it is one.
    fn control_card(&mut self, card: &Card) -> Result<bool, DeckError> {
        // their first data line, where they are read
        let fields = || card.line(0).map(|line| line.fields(&TENS));
        match card.name.as_str() {
            "CONTROL_HOURGLASS" => {
                let coefficient = stiffness_form(&fields()?, card, 0, 1)?;
                self.hourglass.insert(0, Hourglass { coefficient, bulk: None });
            }
            "CONTROL_BULK_VISCOSITY" => {
                let fields = fields()?;
                self.bulk = [fields.real(0, 1.5)?, fields.real(1, 0.06)?];
            }
            "CONTROL_CONTACT" => self.slsfac = nonzero(fields()?.real(0, 0.1)?, 0.1),
            "CONTROL_TIMESTEP" => {
                let fields = fields()?;
                fields.unused(&card.name, &[(4, "DT2MS"), (5, "LCTM")])?;
                self.tssfac = nonzero(fields.real(1, 0.9)?, 0.9);
            }
            "CONTROL_TERMINATION" => self.endtim = Some(fields()?.real(0, 0.0)?),
            "DATABASE_BINARY_D3PLOT" => self.intervals[0] = fields()?.real(0, 0.0)?,
            "DATABASE_BINARY_INTFOR" => self.intervals[1] = fields()?.real(0, 0.0)?,
            _ => return Ok(false),
        }
        Ok(true)
    }

    fn rigid_hub(&mut self, card: &Card) -> Result<(), DeckError> {
        if let Some(before) = &self.hub {
            let what = format!("*{}", card.name);
            let remedy = "keep the hub of the disk alone";
            return Err(second(&card.place, what, &before.place, remedy));
        }
        let fields = card.line(0)?.fields(&TENS);
        fields.unused(&card.name, &[(1, "CID")])?;
        self.axle = Some(fields.id(3)?).filter(|node| *node > 0);
        if card.name.ends_with("INERTIA") {
            let inertia = card.line(1)?.fields(&TENS);
            inertia.unused(&card.name, &[(4, "IRCS")])?;
            self.hub_mass = Some(inertia.real(3, 0.0)?);
        }
        self.hub_part = fields.id(0)?;
        self.hub = Some(Target { set: true, id: fields.id(2)?, place: card.place.clone() });
        Ok(())
    }

    fn nodes(&mut self, card: &Card) -> Result<(), DeckError> {
        for line in card.lines() {
            let fields = line.fields(&[8, 16, 16, 16, 8, 8]);
            fields.unused("NODE", &[(4, "TC"), (5, "RC")])?;
            let mut point = [0.0; 3];
            for (i, x) in point.iter_mut().enumerate() {
                *x = fields.real(1 + i, 0.0)?;
            }
            let id = fields.id(0)?;
            if id == 0 {
                // such as TC and RC on a line of their own, as older long formats have them
                return Err(syntax(&line.place(), "the number of the node is missing"));
            }
            self.nodes.push(Node { id, place: line.place(), point });
        }
        Ok(())
    }

    /// Elements on one line, or number and part on one and the nodes on the next.
    fn solids(&mut self, card: &Card) -> Result<(), DeckError> {
        let mut lines = card.lines();
        while let Some(first) = lines.next() {
            let fields = first.fields(&[8; 10]);
            let (id, part) = (fields.id(0)?, fields.id(1)?);
            let missing = || syntax(&first.place(), "the nodes of the element are missing");
            let (nodes, from) = match fields.id(2)? {
                0 => (lines.next().ok_or_else(missing)?.fields(&[8; 10]), 0),
                _ => (fields, 2),
            };
            let mut corners = [0; 8];
            for (i, corner) in corners.iter_mut().enumerate() {
                *corner = nodes.id(from + i)?;
            }
            if from == 0 && nodes.id(8)? != 0 {
                let what = format!("element {id} of ten nodes");
                let remedy = "mesh both bodies with *ELEMENT_SOLID of eight nodes";
                return Err(unsupported(&first.place(), what, remedy));
            }
            self.solids.push(Solid { id, part, place: first.place(), nodes: corners });
        }
        Ok(())
    }

    /// Pairs of a heading line and a data line.
    fn part(&mut self, card: &Card) -> Result<(), DeckError> {
        let mut lines = card.all_lines();
        while lines.next().is_some() {
            let missing = || syntax(&card.place, "*PART needs a heading and a card");
            let fields = lines.next().ok_or_else(missing)?.fields(&TENS);
            fields.unused("PART", &[(3, "EOSID"), (5, "GRAV"), (6, "ADPOPT"), (7, "TMID")])?;
            let (section, material, hourglass) = (fields.id(1)?, fields.id(2)?, fields.id(4)?);
            let part = Part { section, material, hourglass, place: fields.place() };
            self.parts.insert(fields.id(0)?, part);
        }
        Ok(())
    }

    fn section(&mut self, card: &Card) -> Result<(), DeckError> {
        for line in card.lines() {
            let fields = line.fields(&TENS);
            let form = fields.whole(1)?;
            if !(0..=2).contains(&form) {
                let what = format!("*SECTION_SOLID with ELFORM = {form}");
                return Err(unsupported(
                    &line.place(),
                    what,
                    "use ELFORM 1 (one point) or 2 (full)",
                ));
            }
            self.sections.insert(fields.id(0)?, form.max(1));
        }
        Ok(())
    }

    fn material(&mut self, card: &Card) -> Result<(), DeckError> {
        for line in card.lines() {
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

    fn hourglass(&mut self, card: &Card) -> Result<(), DeckError> {
        for line in card.lines() {
            let fields = line.fields(&TENS);
            let coefficient = stiffness_form(&fields, card, 1, 2)?;
            let bulk = [nonzero(fields.real(4, 1.5)?, 1.5), nonzero(fields.real(5, 0.06)?, 0.06)];
            self.hourglass.insert(fields.id(0)?, Hourglass { coefficient, bulk: Some(bulk) });
        }
        Ok(())
    }

    fn contact(&mut self, card: &Card) -> Result<(), DeckError> {
        if let Some(before) = &self.contact {
            let remedy = "keep that of disk and bar alone";
            return Err(second(&card.place, "contact", &before.place, remedy));
        }
        let sides = card.line(0)?.fields(&TENS);
        sides.unused("CONTACT", &[(4, "SBOXID"), (5, "MBOXID")])?;
        let friction = card.line(1)?.fields(&TENS);
        friction.unused("CONTACT", &[(3, "VC"), (6, "BT")])?;
        if let Some(optional) = card.all_lines().nth(3) {
            let soft = optional.fields(&TENS).whole(0)?;
            if soft != 0 {
                let what = format!("*CONTACT with SOFT = {soft}");
                return Err(unsupported(&optional.place(), what, "use SOFT = 0"));
            }
        }
        self.contact = Some(Contact {
            place: card.place.clone(),
            sides: [side(&sides, 0)?, side(&sides, 1)?],
            fs: friction.real(0, 0.0)?,
            fd: friction.real(1, 0.0)?,
            dc: friction.real(2, 0.0)?,
            vdc: friction.real(4, 0.0)?,
            sf: contact_scale(card)?,
        });
        Ok(())
    }

    fn segment_set(&mut self, card: &Card) -> Result<(), DeckError> {
        let id = card.line(0)?.fields(&TENS).id(0)?;
        let set = self.segment_sets.entry(id).or_default();
        for line in card.further_lines() {
            let fields = line.fields(&TENS);
            let nodes = [fields.id(0)?, fields.id(1)?, fields.id(2)?, fields.id(3)?];
            set.push(nodes);
        }
        Ok(())
    }

    fn clamp(&mut self, card: &Card, set: bool) -> Result<(), DeckError> {
        for line in card.lines() {
            let fields = line.fields(&TENS);
            let fixed = [fields.whole(2)?, fields.whole(3)?, fields.whole(4)?];
            let target = Target { set, id: fields.id(0)?, place: line.place() };
            if fields.whole(1)? == 0 && fixed == [0, 1, 0] {
                self.sliding.push(target);
                continue;
            }
            if fields.whole(1)? != 0 || fixed != [1; 3] {
                let what = format!("*{} with DOFX, DOFY, DOFZ = {fixed:?}", card.name);
                let remedy = "clamp the bar in x, y and z, and hold a plane of symmetry in y alone, in the global system";
                return Err(unsupported(&line.place(), what, remedy));
            }
            self.clamped.push(target);
        }
        Ok(())
    }

    fn load(&mut self, card: &Card, set: bool) -> Result<(), DeckError> {
        for line in card.lines() {
            let fields = line.fields(&TENS);
            fields.unused(&card.name, &[(4, "CID")])?;
            let dof = fields.whole(1)?;
            let on = Target { set, id: fields.id(0)?, place: line.place() };
            let (curve, factor) = (fields.id(2)?, nonzero(fields.real(3, 1.0)?, 1.0));
            let axle = !set && self.axle == Some(on.id);
            if !(dof == 3 || axle && dof == 6) {
                let what = format!("*{} with DOF = {dof}", card.name);
                let remedy =
                    "load the hub in z (DOF = 3), and turn it about y (DOF = 6) at its PNODE";
                return Err(unsupported(&line.place(), what, remedy));
            }
            if axle {
                self.rigid_loads.push(RigidLoad { place: line.place(), dof, curve, factor });
            } else {
                self.loads.push(Load { on, curve, factor });
            }
        }
        Ok(())
    }

    fn curve(&mut self, card: &Card) -> Result<(), DeckError> {
        let fields = card.line(0)?.fields(&TENS);
        let scale = |i: usize| fields.real(i, 1.0).map(|x| nonzero(x, 1.0));
        let ([sfa, sfo], [offa, offo]) =
            ([scale(2)?, scale(3)?], [fields.real(4, 0.0)?, fields.real(5, 0.0)?]);
        let mut points = Vec::new();
        for line in card.further_lines() {
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
fn stiffness_form(fields: &Fields, card: &Card, ihq: usize, qm: usize) -> Result<f64, DeckError> {
    let form = fields.whole(ihq)?;
    if form != 4 && form != 5 {
        let what = format!("*{} with IHQ = {form}", card.name);
        let remedy = "use IHQ 4 or 5: hourglass modes are held by stiffness";
        return Err(unsupported(&card.place, what, remedy));
    }
    Ok(nonzero(fields.real(qm, 0.1)?, 0.1))
}

/// A side of the contact: a set of segments, or parts.
fn side(fields: &Fields, which: usize) -> Result<Side, DeckError> {
    let id = fields.id(which)?;
    match fields.whole(2 + which)? {
        0 => Ok(Side::Segments(id)),
        2 => Ok(Side::PartSet(id)),
        3 => Ok(Side::Part(id)),
        kind => {
            let name = ["SSTYP (SURFATYP)", "MSTYP (SURFBTYP)"][which];
            let what = format!("*CONTACT with {name} = {kind}");
            let remedy = "give each side as a segment set (0), a part set (2) or a part (3)";
            Err(unsupported(&fields.place(), what, remedy))
        }
    }
}

/// `SFS` and `SFM` of a contact, which must be equal; 1 where the card lacks them.
fn contact_scale(card: &Card) -> Result<f64, DeckError> {
    let Some(line) = card.all_lines().nth(2) else { return Ok(1.0) };
    let fields = line.fields(&TENS);
    fields.unused("CONTACT", &[(2, "SST"), (3, "MST")])?;
    for (i, name) in [(4, "SFST"), (5, "SFMT"), (6, "FSF"), (7, "VSF")] {
        let x = fields.real(i, 1.0)?;
        if x != 1.0 && x != 0.0 {
            let what = format!("*CONTACT with {name} = {x}");
            return Err(unsupported(&line.place(), what, "leave the field blank or 1"));
        }
    }
    let [sfs, sfm] = [nonzero(fields.real(0, 1.0)?, 1.0), nonzero(fields.real(1, 1.0)?, 1.0)];
    if sfs != sfm {
        let what = format!("*CONTACT with SFS = {sfs} and SFM = {sfm}");
        return Err(unsupported(&card.place, what, "give both one value: both passes are alike"));
    }
    Ok(sfs)
}

/// Number and members of a set of nodes or parts.
fn members(card: &Card) -> Result<(u64, Vec<u64>), DeckError> {
    let id = card.line(0)?.fields(&TENS).id(0)?;
    let mut members = Vec::new();
    for line in card.further_lines() {
        let fields = line.fields(&TENS);
        for i in 0..8 {
            members.extend(Some(fields.id(i)?).filter(|member| *member > 0));
        }
    }
    Ok((id, members))
}
