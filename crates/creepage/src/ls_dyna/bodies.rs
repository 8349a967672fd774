//! Cards of the two bodies: nodes, elements, parts, sections, materials, hourglass control, and the hub.

use crate::ls_dyna::cards::Card;
use crate::ls_dyna::contact_card;
use crate::ls_dyna::deck::{Deck, Hourglass, Inertia, Material, Node, Part, Solid, Target};
use crate::ls_dyna::error::{DeckError, DeckLine, second, syntax, unsupported};
use crate::ls_dyna::fields::{
    Layout, absent, number, numbers, other_axis, output, real, real_or, rests, whole, zero,
};

const NODE: Layout<4> = Layout::new(&[
    number("NID").wide(8),
    real("X").wide(16),
    real("Y").wide(16),
    real("Z").wide(16),
    zero("TC").wide(8),
    zero("RC").wide(8),
]);

const SOLID: Layout<10> =
    Layout::new(&numbers(["EID", "PID", "N1", "N2", "N3", "N4", "N5", "N6", "N7", "N8"]));

/// The nodes of an element on a line of their own.
const SOLID_NODES: Layout<10> =
    Layout::new(&numbers(["N1", "N2", "N3", "N4", "N5", "N6", "N7", "N8", "N9", "N10"]));

const PART: Layout<4> = Layout::new(&[
    number("PID"),
    number("SECID"),
    number("MID"),
    zero("EOSID"),
    number("HGID"),
    zero("GRAV"),
    zero("ADPOPT"),
    zero("TMID"),
]);

const SECTION: Layout<2> = Layout::new(&[
    number("SECID"),
    whole("ELFORM"),
    zero("AET"),
    zero("unused"),
    zero("unused"),
    zero("unused"),
    zero("COHOFF"),
    zero("GASKETT"),
]);

const ELASTIC: Layout<4> = Layout::new(&[
    number("MID"),
    real("RO"),
    real("E"),
    real("PR"),
    zero("DA"),
    zero("DB"),
    zero("K"),
]);

const HOURGLASS: Layout<5> = Layout::new(&[
    number("HGID"),
    whole("IHQ"),
    real_or("QM", 0.1),
    rests("IBQ", &[1.0]),
    real_or("Q1", 1.5),
    real_or("Q2", 0.06),
    absent("QB/VDC"),
    absent("QW"),
]);

const RIGID_BODY: Layout<3> = Layout::new(&[
    number("PID"),
    zero("CID"),
    number("NSID"),
    number("PNODE"),
    output("IPRT"),
    zero("DRFLAG"),
    zero("RRFLAG"),
]);

const CENTRE_AND_MASS: Layout<5> =
    Layout::new(&[real("XC"), real("YC"), real("ZC"), real("TM"), zero("IRCS"), number("NODEID")]);

const MOMENTS: Layout<1> = Layout::new(&[
    other_axis("IXX"),
    zero("IXY"),
    other_axis("IXZ"),
    real("IYY"),
    zero("IYZ"),
    other_axis("IZZ"),
]);

const VELOCITIES: Layout<0> =
    Layout::new(&[zero("VTX"), zero("VTY"), zero("VTZ"), zero("VRX"), zero("VRY"), zero("VRZ")]);

impl Deck {
    /// Takes a card of the bodies or of their contact; whether it is one.
    pub(super) fn body_card(&mut self, card: &Card) -> Result<bool, DeckError> {
        match card.name.as_str() {
            "NODE" => self.nodes(card)?,
            "ELEMENT_SOLID" => self.solids(card)?,
            "PART" => self.part(card)?,
            "SECTION_SOLID" => self.section(card)?,
            "MAT_ELASTIC" | "MAT_001" => self.material(card)?,
            "HOURGLASS" => self.hourglass(card)?,
            "CONTACT_SURFACE_TO_SURFACE" | "CONTACT_AUTOMATIC_SURFACE_TO_SURFACE" => {
                let contact = contact_card::read(card)?;
                if let Some(before) = self.contact.replace(contact) {
                    let remedy = "keep that of disk and bar alone";
                    return Err(second(&card.place, "contact", &before.place, remedy));
                }
            }
            "CONSTRAINED_NODAL_RIGID_BODY" | "CONSTRAINED_NODAL_RIGID_BODY_INERTIA" => {
                self.rigid_hub(card)?;
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    fn nodes(&mut self, card: &Card) -> Result<(), DeckError> {
        for line in card.lines() {
            let [id, x, y, z] = line.take(&NODE)?;
            if id == 0.0 {
                // such as TC and RC on a line of their own, as older long formats have them
                return Err(syntax(&line.place(), "the number of the node is missing"));
            }
            self.nodes.push(Node { id: id as u64, place: line.place(), point: [x, y, z] });
        }
        Ok(())
    }

    /// Elements on one line, or number and part on one and the nodes on the next.
    fn solids(&mut self, card: &Card) -> Result<(), DeckError> {
        let mut lines = card.lines();
        while let Some(first) = lines.next() {
            let [id, part, nodes @ ..] = first.take(&SOLID)?;
            let id = id as u64;
            let nodes = if nodes == [0.0; 8] {
                let missing = || syntax(&first.place(), "the nodes of the element are missing");
                let [nodes @ .., ninth, tenth] =
                    lines.next().ok_or_else(missing)?.take(&SOLID_NODES)?;
                if [ninth, tenth] != [0.0; 2] {
                    let what = format!("element {id} of ten nodes");
                    let remedy = "mesh both bodies with *ELEMENT_SOLID of eight nodes";
                    return Err(unsupported(&first.place(), what, remedy));
                }
                nodes
            } else {
                nodes
            };
            let nodes = nodes.map(|node| node as u64);
            self.solids.push(Solid { id, part: part as u64, place: first.place(), nodes });
        }
        Ok(())
    }

    /// Pairs of a heading line and a data line.
    fn part(&mut self, card: &Card) -> Result<(), DeckError> {
        let mut lines = card.all_lines();
        while let Some(heading) = lines.next() {
            let line = match lines.next() {
                Some(line) => line,
                // a blank line at the end
                None if heading.text.trim().is_empty() => break,
                None => return Err(syntax(&card.place, "*PART needs a heading and a card")),
            };
            let [id, section, material, hourglass] = line.take(&PART)?.map(|id| id as u64);
            self.first("part", id, &line.place())?;
            self.parts.insert(id, Part { section, material, hourglass, place: line.place() });
        }
        Ok(())
    }

    fn section(&mut self, card: &Card) -> Result<(), DeckError> {
        for line in card.lines() {
            let [id, form] = line.take(&SECTION)?;
            let (id, form) = (id as u64, form as i64);
            if !(0..=2).contains(&form) {
                let what = format!("*SECTION_SOLID with ELFORM = {form}");
                let remedy = "use ELFORM 1 (one point) or 2 (full)";
                return Err(unsupported(&line.place(), what, remedy));
            }
            self.first("section", id, &line.place())?;
            self.sections.insert(id, form.max(1));
        }
        Ok(())
    }

    fn material(&mut self, card: &Card) -> Result<(), DeckError> {
        for line in card.lines() {
            let [id, density, young, poisson] = line.take(&ELASTIC)?;
            self.first("material", id as u64, &line.place())?;
            self.materials.insert(id as u64, Material { density, young, poisson });
        }
        Ok(())
    }

    fn hourglass(&mut self, card: &Card) -> Result<(), DeckError> {
        for line in card.lines() {
            let [id, form, coefficient, q1, q2] = line.take(&HOURGLASS)?;
            stiffness_form(form, card, &line.place())?;
            self.first("hourglass control", id as u64, &line.place())?;
            let bulk = Some([q1, q2]);
            self.hourglass.insert(id as u64, Hourglass { coefficient, bulk });
        }
        Ok(())
    }

    fn rigid_hub(&mut self, card: &Card) -> Result<(), DeckError> {
        if let Some(before) = &self.hub {
            let what = format!("*{}", card.name);
            let remedy = "keep the hub of the disk alone";
            return Err(second(&card.place, what, &before.place, remedy));
        }
        let [part, nodes, axle] = card.line(0)?.take(&RIGID_BODY)?.map(|id| id as u64);
        if card.name.ends_with("INERTIA") {
            let line = card.line(1)?;
            let [x, y, z, mass, node] = line.take(&CENTRE_AND_MASS)?;
            let [moment] = card.line_or_blank(2).take(&MOMENTS)?;
            card.line_or_blank(3).take(&VELOCITIES)?;
            let (place, node) = (line.place(), node as u64);
            self.inertia = Some(Inertia { place, mass, centre: [x, y, z], node, moment });
            card.ends_after(4)?;
        } else {
            card.ends_after(1)?;
        }
        self.axle = Some(axle).filter(|node| *node > 0);
        self.hub_part = part;
        // without a number the set has that of the part
        let id = if nodes == 0 { part } else { nodes };
        self.hub = Some(Target { set: true, id, place: card.place.clone() });
        Ok(())
    }
}

/// Refuses hourglass control that is not one of the stiffness forms of Flanagan and Belytschko, IHQ 4 and 5.
pub(super) fn stiffness_form(form: f64, card: &Card, at: &DeckLine) -> Result<(), DeckError> {
    if form == 4.0 || form == 5.0 {
        return Ok(());
    }
    let what = format!("*{} with IHQ = {form}", card.name);
    Err(unsupported(at, what, "use IHQ 4 or 5: hourglass modes are held by stiffness"))
}
