//! What the cards say of materials, load, motion and contact, and the case file with it.

use crate::cards::unsupported;
use crate::deck::{Contact, Deck, Material};
use crate::model::{Model, lacks};
use crate::shape::Shape;
use crate::units::Units;
use mesh::import::{Fault, ImportError};
use std::collections::HashMap;
use std::fmt::Write as _;
use toml::Value;

/// What the cards say beside the mesh, in the units of the file unless a unit is given.
pub(crate) struct Settings {
    units: Units,
    contact: Contact,
    /// `SLSFAC` times `SFS`.
    penalty: f64,
    /// `TSSFAC`.
    tssfac: f64,
    /// Rolling speed (m/s).
    speed: f64,
    /// Creepage (dimensionless).
    creepage: f64,
    /// Normal force (N).
    normal: f64,
    /// `ENDTIM`.
    end: f64,
    /// Of disk and bar.
    materials: [Material; 2],
    elements: Elements,
}

/// What holds for the elements of both parts.
struct Elements {
    /// Fully integrated, `ELFORM` 2.
    full: bool,
    /// `QM`, where there is a card for it.
    hourglass: Option<f64>,
    /// Quadratic and linear bulk viscosity, Q1 and Q2.
    bulk: [f64; 2],
}

impl Settings {
    /// The settings of a keyword file; choices that had to be made go into `notes`.
    ///
    /// # Errors
    /// Cards that are missing, refer to what is not there, or differ for disk and bar.
    pub(crate) fn of(
        deck: &Deck,
        model: &Model,
        shape: &Shape,
        units: Units,
        notes: &mut Vec<String>,
    ) -> Result<Self, ImportError> {
        let contact = deck.contact.ok_or_else(|| lacks("contact"))?;
        let initial = deck.initial.filter(|initial| initial.speed > 0.0).ok_or_else(|| {
            lacks(
                "*INITIAL_VELOCITY or *INITIAL_VELOCITY_GENERATION with VX above 0: the rolling speed",
            )
        })?;
        let speed = initial.speed * units.velocity();
        let creepage = match initial.spin {
            Some(spin) => spin / units.time() * shape.radius / speed - 1.0,
            None => {
                notes.push("no angular velocity is given: drive.creepage = 0, change it".into());
                0.0
            }
        };
        let normal = load(deck, model, units)?;
        let end = deck.endtim.filter(|t| *t > 0.0).ok_or_else(|| lacks("*CONTROL_TERMINATION"))?;
        let (materials, elements) = parts(deck, model)?;
        if elements.hourglass.is_none() {
            notes.push(
                "no *HOURGLASS: LS-DYNA's default is viscous (IHQ 1), the case holds hourglass modes by \
                 stiffness, element.hourglass = 0.05"
                    .into(),
            );
        }
        if elements.full {
            notes.push(
                "ELFORM 2: the layers of elements below the contact are fully integrated, the others \
                 have one point"
                    .into(),
            );
        }
        let penalty = deck.slsfac * contact.sf;
        let tssfac = deck.tssfac;
        Ok(Self {
            units,
            contact,
            penalty,
            tssfac,
            speed,
            creepage,
            normal,
            end,
            materials,
            elements,
        })
    }
}

/// Materials and elements of the two parts; their elements must be alike.
fn parts(deck: &Deck, model: &Model) -> Result<([Material; 2], Elements), ImportError> {
    let (first, a) = part(deck, model.parts[0])?;
    let (second, b) = part(deck, model.parts[1])?;
    for (what, alike) in [
        ("the formulation of their elements", a.full == b.full),
        ("their hourglass control", a.hourglass == b.hourglass),
        ("their bulk viscosity", a.bulk == b.bulk),
    ] {
        if !alike {
            let line = deck.parts[&model.parts[1]].line;
            let what = format!("a disk and a bar that differ in {what}");
            return Err(unsupported(line, what, "give both parts the same"));
        }
    }
    Ok(([first, second], a))
}

/// Material and elements of a part.
fn part(deck: &Deck, part: u64) -> Result<(Material, Elements), ImportError> {
    let unknown = |what: &str, id: u64, line: usize| {
        let fault = Fault::Unknown { from: format!("part {part}"), what: format!("{what} {id}") };
        ImportError { line: Some(line), fault }
    };
    let card = deck.parts.get(&part).ok_or_else(|| lacks(&format!("*PART {part}")))?;
    let material = deck.materials.get(&card.material);
    let material = *material.ok_or_else(|| unknown("material", card.material, card.line))?;
    let form = deck.sections.get(&card.section);
    let full = *form.ok_or_else(|| unknown("section", card.section, card.line))? == 2;
    let held = match (card.hourglass, deck.hourglass.get(&card.hourglass)) {
        (0, held) => held,
        (id, None) => return Err(unknown("hourglass", id, card.line)),
        (_, held) => held,
    };
    let hourglass = held.map(|h| h.coefficient);
    let bulk = held.and_then(|h| h.bulk).unwrap_or(deck.bulk);
    Ok((material, Elements { full, hourglass, bulk }))
}

/// The case file; `names` are those of the keyword file and of the mesh file.
pub(crate) fn text(settings: &Settings, shape: &Shape, names: [&str; 2]) -> String {
    let [title, mesh_file] = names;
    let mut t = String::new();
    // a comment ends with its line
    let name = title.replace(char::is_control, " ");
    // writing to a String cannot fail, here and below
    let _ = writeln!(
        t,
        "# From {name} by `creepage import-k`; SI units. docs/ls-dyna.md says what became of each card.\n\n\
         title = {}",
        Value::String(format!("from {title}"))
    );
    write_shape(&mut t, shape, mesh_file);
    write_materials(&mut t, settings);
    write_drive(&mut t, settings);
    write_contact(&mut t, settings);
    write_elements(&mut t, settings);
    t
}

fn write_shape(t: &mut String, shape: &Shape, mesh_file: &str) {
    let crown = |crown: Option<f64>| crown.map_or("\"flat\"".into(), six);
    let Shape { zone, .. } = shape;
    let _ = write!(
        t,
        r#"
[disk]                    # measured on the mesh
radius = {}
hub_radius = {}
width = {}
crown_radius = {}

[bar]                     # measured on the mesh
length = {}
width = {}
height = {}
crown_radius = {}
start = {}
ends = "free"             # LS-DYNA's are, without *BOUNDARY_NON_REFLECTING

[mesh]
file = {mesh_file:?}

[mesh.zone]               # the fine part of the bar's top
size = {}
start = {}
length = {}
width = {}
"#,
        six(shape.radius),
        six(shape.hub_radius),
        six(shape.disk_width),
        crown(shape.disk_crown),
        six(shape.length),
        six(shape.bar_width),
        six(shape.height),
        crown(shape.bar_crown),
        six(shape.start),
        six(zone.size),
        six(zone.start),
        six(zone.length),
        six(zone.width)
    );
}

fn write_materials(t: &mut String, settings: &Settings) {
    let units = settings.units;
    for (body, material) in ["disk", "bar"].iter().zip(&settings.materials) {
        let _ = writeln!(
            t,
            "\n[{body}.material]          # *MAT_ELASTIC: E, PR, RO\nyoung = {}\npoisson = {}\ndensity = {}",
            six(material.young * units.stress()),
            six(material.poisson),
            six(material.density * units.density())
        );
    }
}

fn write_drive(t: &mut String, settings: &Settings) {
    let _ = write!(
        t,
        "
[load]
normal = {}              # *LOAD_NODE times its curve at the end

[drive]
speed = {}              # VX
creepage = {}           # OMEGA R/VX - 1
",
        six(settings.normal),
        six(settings.speed),
        six(settings.creepage)
    );
}

fn write_contact(t: &mut String, settings: &Settings) {
    let Settings { contact, units, .. } = settings;
    let falls = contact.dc != 0.0 && contact.fd != contact.fs;
    let law = if falls { "exponential" } else { "coulomb" };
    let _ = writeln!(
        t,
        "\n[friction]                # FD + (FS - FD) exp(-DC v)\nlaw = {law:?}\nstatic = {}",
        six(contact.fs)
    );
    if falls {
        let decay = six(contact.dc / units.velocity());
        let _ = writeln!(t, "dynamic = {}\ndecay = {decay}", six(contact.fd));
    }
    let factor = six(settings.penalty);
    let _ = write!(
        t,
        "
[contact]
curvature = false         # LS-DYNA's contact meets the facets

[contact.penalty]         # SLSFAC times SFS
normal = {factor}
tangential = {factor}
damping = {}              # VDC/100
",
        six(contact.vdc / 100.0)
    );
}

fn write_elements(t: &mut String, settings: &Settings) {
    let Elements { full, hourglass, bulk } = &settings.elements;
    t.push_str("\n[element]\n");
    if let Some(coefficient) = hourglass {
        let _ = writeln!(t, "hourglass = {}          # QM", six(*coefficient));
    }
    t.push_str(if *full {
        "contact_layers = \"full\"   # ELFORM 2\n"
    } else {
        "contact_layers = \"one-point\"   # ELFORM 1\n"
    });
    let _ = write!(
        t,
        "
[damping]                 # Q2 and Q1
bulk_linear = {}
bulk_quadratic = {}

[time]
factor = {}             # TSSFAC
duration = {}          # ENDTIM
",
        six(bulk[1]),
        six(bulk[0]),
        six(settings.tssfac),
        six(settings.end * settings.units.time())
    );
}

/// A number of six significant digits at most.
fn six(x: f64) -> String {
    case::key::number(format!("{x:.5e}").parse().unwrap_or(x))
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
