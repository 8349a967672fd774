//! What the cards say of materials, load, motion and contact, and the case file with it.

use crate::deck::{Contact, Deck, Material};
use crate::drive::{Drive, Turn};
use crate::error::{DeckError, lacks, unknown, unsupported};
use crate::export::NONE;
use crate::model::{Model, Symmetry};
use crate::motion::Damping;
use crate::shape::Shape;
use crate::units::Units;
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
    drive: Drive,
    /// Normal force (N).
    normal: f64,
    /// Whether the height of the hub is held while the disk rolls.
    held: bool,
    /// Mass added to the hub (kg).
    hub_mass: f64,
    /// `ENDTIM` less the time at which the disk begins to roll.
    duration: f64,
    damping: Damping,
    /// Intervals of the records of fields and of interface forces; 0 where the file gives none.
    intervals: [f64; 2],
    /// Whether the bar's ends are quiet.
    quiet: bool,
    symmetry: Symmetry,
    layers: Option<u64>,
    /// Of disk and bar.
    materials: [Material; 2],
    elements: Elements,
}

/// What holds for the elements of both parts.
#[derive(Clone, Copy, Debug)]
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
    ) -> Result<Self, DeckError> {
        let contact = deck.contact.clone().ok_or_else(|| lacks("contact"))?;
        let drive = Drive::of(deck, model, shape, units, notes)?;
        let normal = load(deck, model, units)?;
        let end = deck.endtim.filter(|t| *t > 0.0).ok_or_else(|| lacks("*CONTROL_TERMINATION"))?;
        if deck.begins >= end {
            return Err(lacks("*CONTROL_TERMINATION after the start of the initial velocities"));
        }
        damps_the_preload_alone(deck)?;
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
        // a displacement that ends with the preload hands over to the load
        let depth = deck.motions.iter().find(|motion| motion.dof == 3);
        let held = depth.is_some_and(|motion| !motion.ends);
        Ok(Self {
            units,
            penalty: deck.slsfac * contact.sf,
            contact,
            tssfac: deck.tssfac,
            drive,
            normal,
            held,
            hub_mass: hub_mass(deck, model, units, materials[0].density * units.density()),
            duration: end - deck.begins,
            damping: deck.damping.clone(),
            intervals: deck.intervals,
            quiet: !deck.quiet.is_empty(),
            symmetry: model.symmetry,
            layers: model.layers,
            materials,
            elements,
        })
    }
}

/// The mass of the rigid hub (kg) beyond that of its nodes, of elements of this `density` (kg/m^3).
fn hub_mass(deck: &Deck, model: &Model, units: Units, density: f64) -> f64 {
    let Some(all) = deck.hub_mass.map(|mass| model.alike() * mass * units.mass()) else {
        return 0.0;
    };
    let own = all - model.lumped_mass("hub", density);
    // the rest is what the file's digits leave
    if own > 1e-5 * all { own } else { 0.0 }
}

/// Refuses damping of all motion that does not end before the disk rolls.
fn damps_the_preload_alone(deck: &Deck) -> Result<(), DeckError> {
    let Some((curve, place)) = &deck.damping.global else { return Ok(()) };
    let points = deck.curves.get(curve);
    let late = |[t, value]: &[f64; 2]| *t >= deck.begins && *value != 0.0;
    if points.is_some_and(|points| !points.iter().any(late)) {
        return Ok(());
    }
    let what = "*DAMPING_GLOBAL while the disk rolls, which holds it back";
    Err(unsupported(place, what, "let its curve end with the preload, or use *DAMPING_RELATIVE"))
}

/// Materials and elements of the two parts; their elements must be alike.
fn parts(deck: &Deck, model: &Model) -> Result<([Material; 2], Elements), DeckError> {
    let [(first, a), (second, b)] = [body(deck, &model.parts[0])?, body(deck, &model.parts[1])?];
    for (what, alike) in [
        ("the formulation of their elements", a.full == b.full),
        ("their hourglass control", a.hourglass == b.hourglass),
        ("their bulk viscosity", a.bulk == b.bulk),
    ] {
        if !alike {
            let place = &deck.parts[&model.parts[1][0]].place;
            let what = format!("a disk and a bar that differ in {what}");
            return Err(unsupported(place, what, "give both parts the same"));
        }
    }
    Ok(([first, second], a))
}

/// Material and elements of a body, whose parts may differ in their formulation alone.
fn body(deck: &Deck, parts: &[u64]) -> Result<(Material, Elements), DeckError> {
    let found = parts.iter().map(|id| part(deck, *id)).collect::<Result<Vec<_>, _>>()?;
    let (material, first) = found[0];
    for ((other, elements), id) in found[1..].iter().zip(&parts[1..]) {
        if *other != material
            || elements.hourglass != first.hourglass
            || elements.bulk != first.bulk
        {
            let what = "parts of one body that differ in more than ELFORM";
            let remedy = "give them one material and one hourglass control";
            return Err(unsupported(&deck.parts[id].place, what, remedy));
        }
    }
    let full = found.iter().all(|(_, elements)| elements.full);
    Ok((material, Elements { full, ..first }))
}

/// Material and elements of a part.
fn part(deck: &Deck, part: u64) -> Result<(Material, Elements), DeckError> {
    let card = deck.parts.get(&part).ok_or_else(|| lacks(&format!("*PART {part}")))?;
    let unknown =
        |what: &str, id: u64| unknown(&card.place, format!("part {part}"), format!("{what} {id}"));
    let material = deck.materials.get(&card.material);
    let material = *material.ok_or_else(|| unknown("material", card.material))?;
    let form = deck.sections.get(&card.section);
    let full = *form.ok_or_else(|| unknown("section", card.section))? == 2;
    let held = match (card.hourglass, deck.hourglass.get(&card.hourglass)) {
        (0, held) => held,
        (id, None) => return Err(unknown("hourglass", id)),
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
    write_shape(&mut t, settings, shape, mesh_file);
    write_materials(&mut t, settings);
    write_drive(&mut t, settings);
    write_contact(&mut t, settings);
    write_elements(&mut t, settings);
    t
}

fn write_shape(t: &mut String, settings: &Settings, shape: &Shape, mesh_file: &str) {
    let ends = if settings.quiet { "quiet" } else { "free" };
    let crown = |crown: Option<f64>| crown.map_or("\"flat\"".into(), six);
    let Shape { zone, .. } = shape;
    let symmetry = match settings.symmetry {
        Symmetry::Whole => "",
        Symmetry::Half => "symmetry = \"half\"         # the file's mesh, with its mirror image\n",
        Symmetry::Slice => "plane_strain = true       # no node moves in y\n",
    };
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
ends = "{ends}"             # free without *BOUNDARY_NON_REFLECTING

[mesh]
file = {mesh_file:?}
{symmetry}
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
    let Settings { drive, normal, .. } = settings;
    let _ = writeln!(
        t,
        "\n[load]\nnormal = {}              # the load in z times its curve at the end",
        six(*normal)
    );
    if settings.held {
        t.push_str("mode = \"height\"           # the displacement in z stays\n");
    }
    if settings.hub_mass != 0.0 {
        let _ = writeln!(
            t,
            "hub_mass = {}            # TM, less the mass of the hub's nodes",
            six(settings.hub_mass)
        );
    }
    let _ = writeln!(t, "\n[drive]\nspeed = {}              # VX", six(drive.speed));
    let _ = match drive.turn {
        Turn::Creepage(creepage) => {
            writeln!(
                t,
                "creepage = {}           # of the angular velocity at the end",
                six(creepage)
            )
        }
        Turn::Torque(torque) => {
            writeln!(t, "torque = {}             # about the axle", six(torque))
        }
    };
    if drive.lateral_creepage != 0.0 {
        let _ = writeln!(t, "lateral_creepage = {}   # VY/VX", six(drive.lateral_creepage));
    }
    if let Some(ramp) = drive.ramp {
        let _ = writeln!(t, "ramp = {}               # of the curve", six(ramp));
    }
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
    if let Some(coefficient) = hourglass.map(|q| if q <= NONE { 0.0 } else { q }) {
        let _ = writeln!(t, "hourglass = {}          # QM", six(coefficient));
    }
    t.push_str(if *full || settings.layers.is_some() {
        "contact_layers = \"full\"   # ELFORM 2\n"
    } else {
        "contact_layers = \"one-point\"   # ELFORM 1\n"
    });
    if let Some(layers) = settings.layers {
        let _ = writeln!(t, "layers = {layers}                # of ELFORM 2");
    }
    let time = settings.units.time();
    // what stands for none where 0 stands for a default
    let [quadratic, linear] = bulk.map(|q| if q <= NONE { 0.0 } else { q });
    let _ = write!(
        t,
        "\n[damping]                 # Q2 and Q1\nbulk_linear = {}\nbulk_quadratic = {}\n",
        six(linear),
        six(quadratic),
    );
    if let Some(relative) = settings.damping.relative {
        let _ = writeln!(t, "mass = {}               # *DAMPING_RELATIVE", six(relative / time));
    }
    if let Some(stiffness) = settings.damping.stiffness {
        let _ =
            writeln!(t, "kelvin_voigt = {}       # *DAMPING_PART_STIFFNESS", six(stiffness * time));
    }
    let _ = write!(
        t,
        "\n[time]\nfactor = {}             # TSSFAC\nduration = {}          # ENDTIM, from the start of rolling\n",
        six(settings.tssfac),
        six(settings.duration * time)
    );
    let intervals = settings.intervals.map(|dt| dt * time);
    if intervals.iter().any(|dt| *dt > 0.0) {
        t.push_str("\n[output]                  # *DATABASE_BINARY_D3PLOT, _INTFOR\n");
        for (key, dt) in ["fields_interval", "contact_interval"].iter().zip(intervals) {
            if dt > 0.0 {
                let _ = writeln!(t, "{key} = {}", six(dt));
            }
        }
    }
}

/// A number of six significant digits at most.
fn six(x: f64) -> String {
    case::key::number(format!("{x:.5e}").parse().unwrap_or(x))
}

/// The force that presses the disk down (N): the sum over the loaded nodes and that on the hub, by their curves' last
/// values.
fn load(deck: &Deck, model: &Model, units: Units) -> Result<f64, DeckError> {
    let mut sum = 0.0;
    let places: HashMap<u64, u32> =
        model.foreign.nodes.ids.iter().zip(0..).map(|(id, place)| (*id, place)).collect();
    for load in &deck.loads {
        let unknown = |what: String| unknown(&load.on.place, "the load", what);
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
        sum += load.factor * deck.last(load.curve, &load.on.place)? * nodes.len() as f64;
    }
    for load in deck.rigid_loads.iter().filter(|load| load.dof == 3) {
        sum += load.factor * deck.last(load.curve, &load.place)?;
    }
    if sum >= 0.0 {
        return Err(lacks("*LOAD_NODE_SET or *LOAD_RIGID_BODY that presses the disk down, in -z"));
    }
    Ok(-model.alike() * sum * units.force())
}
