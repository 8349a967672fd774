//! What the cards say of materials, load, motion and contact, and the case file with it.

use crate::ls_dyna::cards::six;
use crate::ls_dyna::deck::{Contact, Deck, Material};
use crate::ls_dyna::drive::{Drive, Turn};
use crate::ls_dyna::error::{DeckError, lacks, unknown, unsupported};
use crate::ls_dyna::export::NONE;
use crate::ls_dyna::loads;
use crate::ls_dyna::model::{Model, Symmetry};
use crate::ls_dyna::plausible::Numbers;
use crate::ls_dyna::shape::Shape;
use crate::ls_dyna::units::Units;
use std::collections::BTreeSet;
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

/// Damping by mass and by stiffness, in units of the file.
struct Damping {
    /// Relative to the motion of the hub (1/time).
    relative: Option<f64>,
    /// Coefficient of the stiffness (time).
    stiffness: Option<f64>,
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
        let (place, ends) = &contact.ends;
        if *ends < deck.end()? {
            let what = format!("*CONTACT with DT = {}, which ends before ENDTIM,", six(*ends));
            return Err(unsupported(place, what, "let the contact last: leave DT blank"));
        }
        loads::kinds(deck)?;
        let drive = Drive::of(deck, model, shape, units, notes)?;
        let normal = loads::normal(deck, model, units, notes)?;
        let damping = Damping::of(deck, model)?;
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
        let numbers = Numbers {
            materials: materials.map(|material| [material.density, material.young]),
            radius: shape.radius / units.length(),
            speed: drive.speed / units.velocity(),
        };
        numbers.fit(units)?;
        let hub_mass =
            hub_mass(deck, model, shape, &drive, units, materials[0].density * units.density())?;
        Ok(Self {
            units,
            penalty: deck.slsfac * contact.sf,
            contact,
            tssfac: deck.tssfac,
            drive,
            normal,
            held: deck.held()?,
            hub_mass,
            duration: deck.rolls()?,
            damping,
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
///
/// # Errors
/// A centre of mass off the axle; a moment of inertia that a hub of this mass does not have, where a torque turns it.
fn hub_mass(
    deck: &Deck,
    model: &Model,
    shape: &Shape,
    drive: &Drive,
    units: Units,
    density: f64,
) -> Result<f64, DeckError> {
    let Some(inertia) = &deck.inertia else { return Ok(0.0) };
    let node = deck.nodes.iter().find(|node| node.id == inertia.node && inertia.node > 0);
    let [x, _, z] = node.map_or(inertia.centre, |node| node.point).map(|x| x * units.length());
    if libm::hypot(x - shape.axle[0], z - shape.axle[1]) > OFF_AXLE * shape.radius {
        let what = "a hub whose centre of mass (XC, ZC or NODEID) is off the axle";
        return Err(unsupported(&inertia.place, what, "put it on the axle"));
    }
    let all = model.alike() * inertia.mass * units.mass();
    let [nodes, of_nodes] = model.lumped("hub", density, shape.radius);
    // what is left is of the file's digits
    let own = if (all - nodes).abs() > 1e-5 * all { all - nodes } else { 0.0 };
    if own < 0.0 {
        let what =
            format!("a hub with TM of {} kg, below the {} kg of its nodes,", six(all), six(nodes));
        let remedy = "give TM with the mass of the nodes: a half of it where the model is a half";
        return Err(unsupported(&inertia.place, what, remedy));
    }
    let moment = model.alike() * inertia.moment * units.mass() * units.length().powi(2);
    let expected = of_nodes + 0.5 * own * shape.hub_radius.powi(2);
    if matches!(drive.turn, Turn::Torque(_)) && (moment - expected).abs() > ALIKE * expected {
        let [given, of_case] = [moment, expected].map(six);
        let what = format!("a hub with IYY = {given} kg m^2, where a case has {of_case} kg m^2,");
        let remedy = "give it the moment of its nodes and, for the rest of TM, that of a cylinder";
        return Err(unsupported(&inertia.place, what, remedy));
    }
    Ok(own)
}

/// Share of the radius by which a centre of mass may be off the axle.
const OFF_AXLE: f64 = 1e-4;
/// Share by which moments of inertia may differ.
const ALIKE: f64 = 1e-2;

impl Damping {
    /// The damping of a case: what all parts of both bodies, or all of the disk's, have alike.
    ///
    /// # Errors
    /// Damping of other parts, of parts alone, or relative to another body than the hub.
    fn of(deck: &Deck, model: &Model) -> Result<Self, DeckError> {
        damps_the_preload_alone(deck)?;
        let cards = &deck.damping;
        let relative = match &cards.relative {
            Some(relative) => {
                deck.of_the_hub("DAMPING_RELATIVE", relative.body, &relative.place)?;
                let set = deck.part_sets.get(&relative.parts);
                let parts = |set: &Vec<u64>| set.iter().copied().collect::<BTreeSet<_>>();
                if set.map(parts) != Some(model.parts[0].iter().copied().collect()) {
                    let what = format!("*DAMPING_RELATIVE of PSID {}", relative.parts);
                    let remedy = "damp the disk: PSID is the set of all its parts";
                    return Err(unsupported(&relative.place, what, remedy));
                }
                Some(relative.rate)
            }
            None => None,
        };
        let Some((first, (coefficient, place))) = cards.stiffness.first_key_value() else {
            return Ok(Self { relative, stiffness: None });
        };
        let of_part = |part: &u64| cards.stiffness.get(part).map(|(coefficient, _)| *coefficient);
        let parts: BTreeSet<_> = model.parts.iter().flatten().copied().collect();
        if let Some((part, (_, at))) =
            cards.stiffness.iter().find(|(part, _)| !parts.contains(part))
        {
            return Err(unknown(
                at,
                "*DAMPING_PART_STIFFNESS",
                format!("part {part} of disk and bar"),
            ));
        }
        if let Some(part) = parts.iter().find(|part| of_part(part) != Some(*coefficient)) {
            let what = format!("*DAMPING_PART_STIFFNESS of part {first} that part {part} lacks");
            let remedy = "give all parts of both bodies the same COEF: a case has one";
            return Err(unsupported(place, what, remedy));
        }
        Ok(Self { relative, stiffness: Some(*coefficient) })
    }
}

/// Refuses damping of all motion that does not end before the disk rolls.
fn damps_the_preload_alone(deck: &Deck) -> Result<(), DeckError> {
    let Some((curve, place)) = &deck.damping.global else { return Ok(()) };
    let course = deck.course(*curve, place)?;
    if course.last == 0.0 && course.is_constant() {
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
normals = \"face\"

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
