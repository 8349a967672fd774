//! The whole state of a run as a checkpoint, and back.

use std::time::{Duration, Instant};

use crate::means::Means;
use crate::record::RecorderState;
use crate::schema;
use crate::start::Found;
use contact::ContactState;
use dynamics::{Energies, HubState, LEDGER_NUMBERS, Ledger, SimulationState, Timers, Watch};
use output::{Array, Checkpoint, Numbers, Provenance, Results};

/// Attributes: what was found before rolling, as JSON, and the instruction set of the kernels.
const FOUND: &str = "found";
pub(crate) const KERNELS: &str = "kernels";
/// Group of the columns of contact.
const CONTACT: &str = "contact/";

/// Everything that a run needs to go on with the same bits.
pub(crate) struct State {
    pub(crate) simulation: SimulationState,
    pub(crate) recorder: RecorderState,
    /// The last energies read.
    pub(crate) energies: Energies,
    pub(crate) found: Found,
    /// Wall time of everything and of rolling so far.
    pub(crate) wall: [Duration; 2],
}

/// When the next checkpoint is due.
pub(crate) struct Clock {
    steps: Option<u64>,
    wall: Option<Duration>,
    /// Step and instant of the last one, or of the beginning.
    last: (u64, Instant),
    /// Whether the first is due at once.
    first: bool,
}

impl Clock {
    pub(crate) fn new(case: &schema::Checkpoint, dt: f64, step: u64) -> Self {
        let in_time = case.time.map(|time| (time / dt).round().max(1.0) as u64);
        Self {
            steps: case.steps.into_iter().chain(in_time).min(),
            wall: (case.wall_minutes > 0.0)
                .then(|| Duration::from_secs_f64(60.0 * case.wall_minutes)),
            last: (step, Instant::now()),
            first: step == 0,
        }
    }

    /// Whether one is due before step `step`; the next interval then begins.
    pub(crate) fn is_due(&mut self, step: u64) -> bool {
        let (at, instant) = self.last;
        // what the preload has found is kept at once
        let any = self.steps.is_some() || self.wall.is_some();
        let due = (self.first && any)
            || self.steps.is_some_and(|interval| step - at >= interval)
            || self.wall.is_some_and(|interval| instant.elapsed() >= interval);
        if due {
            self.first = false;
            self.last = (step, Instant::now());
        }
        due
    }
}

impl State {
    /// The checkpoint; its results are the writer's to fill in.
    pub(crate) fn into_checkpoint(self, provenance: &Provenance, kernels: &str) -> Checkpoint {
        let simulation = self.simulation;
        let mut provenance = provenance.clone();
        let found = serde_json::to_string(&self.found).unwrap_or_default();
        provenance.attributes = vec![(FOUND.into(), found), (KERNELS.into(), kernels.into())];
        let watch = simulation.watch;
        let mut arrays = vec![
            vectors("nodes/displacement", "m", "displacement", &simulation.displacement),
            vectors("nodes/velocity", "m/s", "velocity half a step before", &simulation.velocity),
            vectors(
                "quiet_ends/reaction",
                "N",
                "forces that balance the preload",
                &simulation.reactions,
            ),
            real("ledger", "J", "works and energy balance so far", &simulation.ledger.numbers()),
            real("energies", "J", "energies when last read", &self.energies.numbers()),
            real(
                "guards",
                "1, s",
                "1 if there was contact; since when there is none, negative if there is",
                &[f64::from(u8::from(watch.touched)), watch.lost.unwrap_or(-1.0)],
            ),
            real("recorder/next_fields", "s", "next snapshot", &[self.recorder.next_fields]),
            real(
                "recorder/means",
                "1",
                "means over the evaluation window so far: samples, mean, sum of squares, in SI \
                 units; extremes",
                &self.recorder.means.numbers(),
            ),
        ];
        if let Some((at, reaction)) = simulation.hub {
            let motion = [at.x, at.z, at.angle, at.vx, at.vz, at.omega];
            let text = "displacement x, z and angle; velocities of the half step before";
            arrays.push(real("hub/motion", "m, m, rad, m/s, m/s, rad/s", text, &motion));
            arrays.push(real(
                "hub/reaction",
                "N, N, N m",
                "last force of the drive",
                &[reaction.force_x, reaction.force_z, reaction.torque],
            ));
        }
        let timers = simulation.timers;
        let [all, rolling] = self.wall;
        let wall = [
            all,
            rolling,
            self.recorder.wall,
            timers.internal_force,
            timers.contact,
            timers.boundary,
            timers.nodes,
        ];
        let text = "wall time so far: all, rolling, output, and the stages of the steps";
        arrays.push(real("wall", "s", text, &wall.map(|d| d.as_secs_f64())));
        for column in simulation.contact.unwrap_or_default().columns {
            arrays.push(Array {
                name: format!("{CONTACT}{}", column.name),
                units: column.units,
                components: column.components,
                description: "state of contact".into(),
                values: match column.values {
                    contact::Numbers::Real(values) => Numbers::Real(values),
                    contact::Numbers::Whole(values) => {
                        Numbers::Whole(values.into_iter().map(u64::from).collect())
                    }
                },
            });
        }
        let step = simulation.step as u64;
        Checkpoint { provenance, step, results: Results::default(), arrays }
    }

    /// The reverse; says what is missing.
    pub(crate) fn from_checkpoint(checkpoint: &Checkpoint) -> Result<Self, String> {
        let found = checkpoint.text(FOUND).ok_or("it does not say how the run began")?;
        let found = serde_json::from_str(found).map_err(|error| error.to_string())?;
        let find = |name: &str| {
            let array = checkpoint.arrays.iter().find(|array| array.name == name);
            match array.map(|array| &array.values) {
                Some(Numbers::Real(values)) => Ok(values.as_slice()),
                _ => Err(format!("it has no numbers `{name}`")),
            }
        };
        let vectors = |name: &str| find(name).map(|values| values.as_chunks::<3>().0.to_vec());
        let [all, rolling, output, internal_force, contact, boundary, nodes] =
            fixed(find("wall")?)?.map(|s| Duration::try_from_secs_f64(s).unwrap_or_default());
        let hub = match find("hub/motion") {
            Ok(motion) => {
                let [x, z, angle, vx, vz, omega] = fixed(motion)?;
                let [force_x, force_z, torque] = fixed(find("hub/reaction")?)?;
                let reaction = dynamics::DriveReaction { force_x, force_z, torque };
                Some((HubState { x, z, angle, vx, vz, omega }, reaction))
            }
            Err(_) => None,
        };
        let watch = match find("guards") {
            Ok(numbers) => {
                let [touched, lost] = fixed(numbers)?;
                Watch { touched: touched != 0.0, lost: (lost >= 0.0).then_some(lost) }
            }
            Err(_) => Watch::default(),
        };
        let columns: Vec<_> = checkpoint.arrays.iter().filter_map(column).collect();
        let [next_fields] = fixed(find("recorder/next_fields")?)?;
        Ok(Self {
            simulation: SimulationState {
                step: checkpoint.step as usize,
                displacement: vectors("nodes/displacement")?,
                velocity: vectors("nodes/velocity")?,
                hub,
                reactions: vectors("quiet_ends/reaction")?,
                ledger: Ledger::from_numbers(fixed::<LEDGER_NUMBERS>(find("ledger")?)?),
                contact: (!columns.is_empty()).then_some(ContactState { columns }),
                watch,
                timers: Timers { internal_force, contact, boundary, nodes },
            },
            recorder: RecorderState {
                next_fields,
                means: Means::from_numbers(&fixed(find("recorder/means")?)?),
                wall: output,
            },
            energies: Energies::from_numbers(fixed(find("energies")?)?),
            found,
            wall: [all, rolling],
        })
    }
}

fn real(name: &str, units: &str, description: &str, values: &[f64]) -> Array {
    Array {
        name: name.into(),
        units: units.into(),
        components: 1,
        description: description.into(),
        values: Numbers::Real(values.to_vec()),
    }
}

fn vectors(name: &str, units: &str, description: &str, values: &[[f64; 3]]) -> Array {
    Array { components: 3, ..real(name, units, description, values.as_flattened()) }
}

/// A column of contact.
fn column(array: &Array) -> Option<contact::Column> {
    Some(contact::Column {
        name: array.name.strip_prefix(CONTACT)?.into(),
        units: array.units.clone(),
        components: array.components,
        values: match &array.values {
            Numbers::Real(values) => contact::Numbers::Real(values.clone()),
            Numbers::Whole(values) => {
                contact::Numbers::Whole(values.iter().map(|&n| n as u32).collect())
            }
        },
    })
}

fn fixed<const N: usize>(values: &[f64]) -> Result<[f64; N], String> {
    values.try_into().map_err(|_| format!("it has {} numbers where {N} belong", values.len()))
}
