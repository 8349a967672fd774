//! What a run of half-spaces writes while it rolls.

use crate::case::schema::Case;
use crate::run::error::RunError;
use crate::run::means::Means;
use crate::run::record::RecordBasis;
use crate::run::record::contact::{ContactRecord, RollingStep};
use crate::run::record::row::Whereabouts;
use crate::run::record::surfaces::Surfaces;
use crate::scenario::{BAR, DISK, HalfSpaceModel, SurfacePoints};
use contact::{ContactSums, NodalContact};
use dynamics::{DriveReaction, Energies, StepReport};
use halfspace::{PatchPoint, StepSums};
use nalgebra::Vector3;
use output::{Checkpoint, OutputError, Results};
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::time::{Duration, Instant};

/// Writes contact and history.
pub(super) struct HalfSpaceRecorder {
    contact: ContactRecord,
    points: SurfacePoints,
    spacing: f64,
    width: f64,
    /// Columns by which the recorded points have moved on with the contact.
    travel: i64,
    /// Displacement (m) and velocity (m/s) of the points of disk and bar.
    displacement: Vec<Vector3<f64>>,
    velocity: Vec<Vector3<f64>>,
    state: HalfSpaceRecorderState,
}

/// What the recorder carries from step to step.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct HalfSpaceRecorderState {
    means: Means,
    facts: SolverFacts,
    /// Wall time of output so far.
    wall: Duration,
}

/// What is known of the solution of the tangential problem over the run.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub(super) struct SolverFacts {
    /// Iterations of all steps, and of the step with the most.
    pub(super) iterations: u64,
    /// See `iterations`.
    pub(super) most: u64,
    /// Steps in which a point left perfect delay.
    pub(super) undelayed: u64,
    /// Wall time of output.
    pub(super) output: Duration,
}

impl HalfSpaceRecorder {
    pub(super) fn new(
        case: &Case,
        model: &HalfSpaceModel,
        basis: &RecordBasis,
    ) -> Result<Self, RunError> {
        let (points, spacing) = (model.points.clone(), case.mesh.zone.size);
        let rows = Rows::of(&points);
        let places = rows.places(&points, spacing, case.mesh.zone.width);
        let area = rows.areas(spacing, case.mesh.zone.width);
        let n = places.len();
        let numbers = |side: usize| (side * n..(side + 1) * n).map(|i| i as u32).collect();
        let surfaces = Surfaces {
            tables: [DISK, BAR].map(|side| NodalContact::of_nodes(numbers(side), area.clone())),
            points: [places.clone(), places],
            faces: &[rows.faces(), rows.faces()],
            enforced_on: Some(DISK),
            half: false,
        };
        let step =
            RollingStep { dt: model.rolling.step_length(), effective_radius: case.disk.radius };
        let files = ContactRecord::files(case, &surfaces, basis, None)?;
        Ok(Self {
            contact: ContactRecord::new(case, surfaces, &step, basis.hertz_pressure, files)?,
            spacing,
            width: model.width,
            travel: 0,
            displacement: vec![Vector3::zeros(); 2 * n],
            velocity: vec![Vector3::zeros(); 2 * n],
            state: HalfSpaceRecorderState::default(),
            points,
        })
    }

    /// The state, after all rows are handed to the writer.
    pub(super) fn snapshot(&mut self) -> Result<HalfSpaceRecorderState, RunError> {
        self.contact.flush()?;
        Ok(HalfSpaceRecorderState { means: self.contact.means.clone(), ..self.state.clone() })
    }

    /// Takes over the state of the recorder that began the files.
    pub(super) fn restore(&mut self, state: &HalfSpaceRecorderState) {
        self.contact.means = state.means.clone();
        self.state = state.clone();
    }

    /// Has the writer write the checkpoint that `make` returns, after everything sent before.
    pub(super) fn keep(
        &mut self,
        make: impl FnOnce(Results) -> Result<Checkpoint, OutputError> + Send + 'static,
        folder: &Path,
    ) -> Result<(), RunError> {
        self.contact.keep(make, folder, None)
    }

    /// To be called after each step.
    pub(super) fn after_step(
        &mut self,
        case: &Case,
        model: &HalfSpaceModel,
        sums: &StepSums,
        energies: &Energies,
    ) -> Result<(), RunError> {
        let clock = Instant::now();
        let facts = &mut self.state.facts;
        facts.iterations += sums.iterations as u64;
        facts.most = facts.most.max(sums.iterations as u64);
        facts.undelayed += u64::from(sums.undelayed > 0);
        let report = self.report(case, sums, energies);
        let step = self.contact.add_step(&report);
        let n = sums.step as u64;
        let (reads, records) = (self.contact.reads(n), self.contact.records(n));
        if reads || records {
            self.fill(model);
        }
        if records {
            self.contact.write(sums.time, &self.displacement, &self.velocity)?;
        }
        if reads {
            let travel = self.travel as f64 * self.spacing;
            let patch = self.contact.patch(sums.centre - travel);
            let stored = energies.internal + energies.friction_dissipated;
            let at = Whereabouts {
                hub_x: sums.centre,
                hub_z: 0.0,
                window_x: travel,
                window_energy: 0.0,
                imbalance: stored - energies.external_work,
            };
            self.contact.add_row(&report, &step, &patch, &at)?;
        }
        self.state.facts.output += clock.elapsed();
        Ok(())
    }

    /// What is known of the solution so far.
    pub(super) fn facts(&self) -> SolverFacts {
        self.state.facts
    }

    /// Writes what is left, closes the files and returns the means.
    pub(super) fn finish(self) -> Result<Means, RunError> {
        self.contact.finish()
    }

    /// The report of a step, as the time loop of finite elements gives it.
    fn report(&self, case: &Case, sums: &StepSums, energies: &Energies) -> StepReport {
        let [tx, ty, normal] =
            [sums.shear[0], sums.shear[1], sums.normal].map(|force| self.width * force);
        StepReport {
            step: sums.step,
            time: sums.time,
            contact: ContactSums {
                force: [[tx, ty, normal], [-tx, -ty, -normal]].map(Into::into),
                normal_force: normal,
                sweeps: sums.iterations,
                unconverged: sums.unconverged,
                non_unique: sums.non_unique,
                closed: sums.points,
                sticking: sums.points - sums.slipping,
                slipping: sums.slipping,
                ..ContactSums::default()
            },
            energies: Some(*energies),
            drive: DriveReaction {
                force_x: -tx,
                force_z: -normal,
                torque: tx * case.disk.radius,
                ..DriveReaction::default()
            },
            omega: (1.0 + sums.creepage) * case.drive.speed / case.disk.radius,
            unsolved: None,
        }
    }

    /// Fills the tables of both surfaces, and moves the points on where they follow the contact.
    fn fill(&mut self, model: &HalfSpaceModel) {
        let rows = Rows::of(&self.points);
        if let Some(columns) = self.points.move_on {
            let centre = (model.rolling.centre() / self.spacing).floor() as i64;
            // at half a move, as a mesh does: the patch lies behind the middle as far as ahead of it
            let columns = columns as i64;
            self.travel = (centre + columns / 2).div_euclid(columns) * columns;
        }
        // in linear theory points that are opposite stay so: none is displaced but by the moves of the grid
        let travel = Vector3::new(self.travel as f64 * self.spacing, 0.0, 0.0);
        self.displacement.fill(travel);
        self.velocity.fill(Vector3::zeros());
        let law = model.rolling.mu_static();
        for table in &mut self.contact.tables {
            for values in [&mut table.pressure, &mut table.pass_pressure] {
                values.fill(0.0);
            }
            for values in [&mut table.shear, &mut table.slip_velocity, &mut table.slip] {
                values.fill(Vector3::zeros());
            }
            table.mu.fill(law);
            table.state.fill(0);
            // beyond the patch: farther than any point of it
            table.gap.fill(self.spacing);
        }
        let n = rows.count();
        for point in model.rolling.patch() {
            let along = point.column - self.points.columns.0 - self.travel;
            for row in rows.of_point(along, point.line) {
                for (side, sign) in [(DISK, 1.0), (BAR, -1.0)] {
                    let table = &mut self.contact.tables[side];
                    set(table, row, &point, sign);
                    // each surface takes half of the elastic motion, and the disk the rigid slip
                    let i = side * n + row;
                    for c in 0..2 {
                        let elastic = 0.5 * sign * point.rate[c];
                        let rigid = point.slip_velocity[c] - point.rate[c];
                        self.velocity[i][c] = if side == DISK { elastic + rigid } else { elastic };
                    }
                }
            }
        }
    }
}

fn set(table: &mut NodalContact, row: usize, point: &PatchPoint, sign: f64) {
    let on_surface = |v: [f64; 2]| [sign * v[0], sign * v[1], 0.0].into();
    table.pressure[row] = point.pressure;
    table.pass_pressure[row] = point.pressure;
    table.shear[row] = on_surface(point.shear);
    table.slip_velocity[row] = on_surface(point.slip_velocity);
    table.slip[row] = on_surface(point.slip);
    table.mu[row] = point.mu;
    table.state[row] = if point.slips { 2 } else { 1 };
    table.gap[row] = 0.0;
}

/// Rows of the tables: column by column along x, line after line across; in plane strain two lines that hold the same.
#[derive(Clone, Copy)]
struct Rows {
    columns: usize,
    /// Lines, and whether they are the two edges of plane strain.
    lines: usize,
    edges: bool,
}

impl Rows {
    fn of(points: &SurfacePoints) -> Self {
        let lines = points.lines.map_or(2, |lines| 2 * lines + 1);
        Self { columns: points.columns.1, lines, edges: points.lines.is_none() }
    }

    fn count(&self) -> usize {
        self.columns * self.lines
    }

    /// Undeformed places (m) of the points.
    fn places(&self, points: &SurfacePoints, h: f64, width: f64) -> Vec<Vector3<f64>> {
        let (first, lines) = (points.columns.0, points.lines.unwrap_or(0) as f64);
        let y = |line: usize| match self.edges {
            true => (line as f64 - 0.5) * width,
            false => (line as f64 - lines) * h,
        };
        let x = |column: usize| (first + column as i64) as f64 * h;
        (0..self.lines)
            .flat_map(|line| {
                (0..self.columns).map(move |column| Vector3::new(x(column), y(line), 0.0))
            })
            .collect()
    }

    /// Areas (m^2) of the points.
    fn areas(&self, h: f64, width: f64) -> Vec<f64> {
        let across = if self.edges { 0.5 * width } else { h };
        vec![h * across; self.count()]
    }

    fn faces(&self) -> Vec<[u32; 4]> {
        let row = |column: usize, line: usize| (column + self.columns * line) as u32;
        (1..self.lines)
            .flat_map(|j| (1..self.columns).map(move |i| (i, j)))
            .map(|(i, j)| [row(i - 1, j - 1), row(i, j - 1), row(i, j), row(i - 1, j)])
            .collect()
    }

    /// The rows of a point of the patch, `along` columns from the first; none where it lies beyond them.
    fn of_point(&self, along: i64, line: i64) -> impl Iterator<Item = usize> + use<> {
        let Self { columns, lines, edges } = *self;
        let inside = (0..columns as i64).contains(&along);
        let middle = (lines / 2) as i64;
        (0..lines)
            .filter(move |&j| inside && (edges || j as i64 == line + middle))
            .map(move |j| along as usize + columns * j)
    }
}
