//! A block sliding on a plane: Coulomb friction of penalty and of exact contact compared with rigid-body
//! mechanics.
//!
//! *Stop.* A block under the weight m g slides with the start velocity v_0: x = v_0 t - mu g t^2/2 until it stops at
//! v_0^2/(2 mu g), and stays there. *Incline.* On a plane at the angle alpha the block sticks for
//! tan(alpha) < mu and slides with a = g (sin(alpha) - mu cos(alpha)) above (Coulomb 1781).
//!
//! The block and the friction springs of the contact are elastic; the plane is a held body. With
//! the weight p = rho g H per area and k_t the areal stiffness of both passes, friction displaces the block elastically
//! by d = mu p/k_t + mu rho g H^2/(2G). The limits follow from d:
//! - a block that slides already: 2 d, for a sudden load, at the start and again at the stop;
//! - a block held at the share s = tan(alpha)/mu of its friction, loaded suddenly: the springs hold
//!   mu m g from d on, and the work of the load is used up at s x = x - d/2, hence d/(2 (1 - s)) for
//!   s > 1/2; or 2 d, for a sudden load, where that is more;
//! - a block that starts to slide: while its springs are loaded it gains at most the speed
//!   v_1 = sqrt(2 g sin(alpha) d), from the work of the load over d, and runs ahead by v_1 t.
//!
//! Exact contact has no springs: d is then that of the block alone, mu rho g H^2/(2G). For a sliding block the limits
//! are closer:
//! - while it slides, its centre of mass obeys m x'' = -mu N and m (g + z'') = N, however the block deforms: the error
//!   of x is mu times the rise and fall of the centre, at most twice the sag under the weight, rho g H^2/(3E);
//! - at the stop the shear of the block is released suddenly, 2 d: so much may be missing in the distance and the heat;
//! - a block that has stopped stays: the nodes on the plane stick, up to a rounding in each step.
//!
//! With mortar constraints the elements of the plane are 0.8 times as long as those of the block.
//!
//! The block first settles under its weight, with critically damped contact springs, or on exact
//! contact with damping in proportion to mass. With exact contact, which has no dampers, the elements then have
//! Kelvin–Voigt damping of 0.3 time steps: an elastic body of finite height that slides steadily on a rigid
//! one is unstable without damping for any law of friction, by waves between its faces that grow at
//! a rate in inverse proportion to its height (Brener, Weikamp, Spatschek, Bar-Sinai and Bouchbinder 2016, J. Mech.
//! Phys. Solids 89: 149–173).

use crate::body::{STEEL, at_rest, contact_material, side_nodes};
use crate::problem::{Cause, Outcome, Size};
use crate::row::Row;
use contact::{
    BodyMaterial, ContactStep, ExactContact, ExactSettings, Normals, PenaltyContact,
    PenaltySettings, Rows, Stiffness,
};
use dynamics::{Load, Setup, Simulation};
use friction::Coulomb;
use mesh::{Mesh, Padded, Surface};
use nalgebra::Vector3;
use solid::{Element, Level, Material, Solid, Viscosity};

pub(crate) const MU: f64 = 0.3;
/// Acceleration (m/s^2) that lets a millimetre block stop within some thousand steps.
const GRAVITY: f64 = 2e4;
/// Edges of the block (m), so flat that friction does not lift its rear: mu H/2 < L/6.
const BLOCK: [f64; 3] = [8e-3, 4e-3, 2e-3];
/// Without Poisson's effect the sides of the block stay straight under its weight.
const MATERIAL: Material = Material { poisson: 0.0, ..STEEL };
/// Length of the plane, from one block's length behind the block (m).
const PLANE: f64 = 40e-3;
/// Time to settle (s), about ten periods of the block on its springs.
const SETTLING: f64 = 6e-5;
/// Areal stiffness of both passes (N/m^3), normal and tangential.
const SPRING: f64 = 4e13;

/// Multiple of d in the limit of a sliding block: doubled by a sudden load, at the start and at the stop.
const SUDDEN: f64 = 4.0;

/// The tolerance of implicit steps.
const IMPLICIT: f64 = 1e-8;

/// How contact is enforced.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Method {
    Penalty,
    Exact(Rows),
    /// Exact contact with implicit steps of this theta, so many times as long as the explicit ones.
    Implicit {
        theta: f64,
        longer: f64,
    },
}

const FROM: &str = "elastic give d of friction springs and block, loaded at once (module text)";
const SAG: &str = "mu times the sag of the block under its weight, loaded at once (module text)";

pub(crate) fn stop(size: Size) -> Outcome {
    stops(size, Method::Penalty)
}

pub(crate) fn stop_exact(size: Size) -> Outcome {
    stops(size, Method::Exact(Rows::NodeToFace))
}

#[cfg(test)]
pub(crate) fn stop_exact_with(size: Size, mu: f64) -> Outcome {
    stops_with(size, Method::Exact(Rows::NodeToFace), mu)
}

/// Exact contact with implicit steps ten times as long as the explicit ones.
pub(crate) fn stop_implicit(size: Size) -> Outcome {
    stops(size, Method::Implicit { theta: 0.5, longer: 10.0 })
}

/// The displacements along x of the nodes of a block that has slid for `time` (s) at 1.5 m/s at first (m).
pub(crate) fn slid(size: Size, method: Method, time: f64) -> Result<Vec<f64>, Cause> {
    let mut block = Block::new(size, method, weight(0.0), 1.5, MU)?;
    let steps = (time / block.simulation.dt()).round() as usize;
    for _ in 0..steps {
        block.simulation.step(false);
    }
    let u = &block.simulation.displacement()[..block.masses.len()];
    Ok(u.iter().map(|u| u[0]).collect())
}

/// The time step of the explicit block (s).
pub(crate) fn step(size: Size) -> Result<f64, Cause> {
    let method = Method::Exact(Rows::NodeToFace);
    Ok(Block::new(size, method, weight(0.0), 1.5, MU)?.simulation.dt())
}

pub(crate) fn stop_mortar(size: Size) -> Outcome {
    stops(size, Method::Exact(Rows::Mortar))
}

fn stops(size: Size, method: Method) -> Outcome {
    stops_with(size, method, MU)
}

/// The problem with the coefficient `mu` in the contact, beside the closed form of [`MU`].
fn stops_with(size: Size, method: Method, mu: f64) -> Outcome {
    let v0 = 1.5;
    let (time, distance) = (v0 / (MU * GRAVITY), v0 * v0 / (2.0 * MU * GRAVITY));
    let (sliding, limit) = match method {
        Method::Penalty => {
            let limit = (SUDDEN * elastic_displacement(method) / distance, FROM);
            (limit, limit)
        }
        Method::Exact(_) | Method::Implicit { .. } => {
            let sag = MATERIAL.density * GRAVITY * BLOCK[2].powi(2) / (3.0 * MATERIAL.young);
            let sliding = (2.0 * MU * sag / distance, SAG);
            (sliding, (2.0 * elastic_displacement(method) / distance, FROM))
        }
    };
    let mut block = Block::new(size, method, weight(0.0), v0, mu)?;
    let mut earlier = 0.0;
    if method == Method::Penalty {
        // the first step of penalty contact adds the heat of the step that ended at t = 0
        block.simulation.step(false);
        earlier = block.simulation.ledger().friction;
    }
    let source = "x = v0 t - mu g t^2/2";
    let mut rows = Vec::new();
    for share in [0.25, 0.5, 0.75] {
        let t = share * time;
        let x = block.slide_until(t);
        let t = if block.every_step { block.simulation.time() } else { t };
        let exact = v0 * t - 0.5 * MU * GRAVITY * t * t;
        let quantity = format!("x at t = {share} v0/(mu g) (m)");
        rows.push(Row::new(quantity, [exact, x], distance, sliding, source));
    }
    let x = block.slide_until(1.2 * time);
    let stop = [distance, x];
    rows.push(Row::new("distance to the stop (m)", stop, distance, limit, "v0^2/(2 mu g)"));
    let (steps, base) = (block.simulation.steps(), block.base_displacement());
    let later = block.slide_until(1.5 * time);
    let (creep, held) = match method {
        Method::Penalty => (later - x, limit),
        Method::Implicit { .. } => {
            let part = (IMPLICIT, "the tolerance of implicit steps");
            (block.base_displacement() - base, part)
        }
        Method::Exact(_) => {
            let roundings = (block.simulation.steps() - steps) as f64 * f64::EPSILON;
            (
                block.base_displacement() - base,
                (roundings, "one rounding of the displacement per step"),
            )
        }
    };
    let creep = [0.0, creep / distance];
    rows.push(Row::new("creep after the stop over the distance", creep, 1.0, held, "adhesion"));
    let heat = block.simulation.ledger().friction - earlier;
    let kinetic = 0.5 * block.mass * v0 * v0;
    let source = "the kinetic energy m v0^2/2";
    rows.push(Row::new("heat of friction (J)", [kinetic, heat], kinetic, limit, source));
    Ok(rows)
}

pub(crate) fn incline(size: Size) -> Outcome {
    inclines(size, Method::Penalty)
}

pub(crate) fn incline_exact(size: Size) -> Outcome {
    inclines(size, Method::Exact(Rows::NodeToFace))
}

pub(crate) fn incline_mortar(size: Size) -> Outcome {
    inclines(size, Method::Exact(Rows::Mortar))
}

fn inclines(size: Size, method: Method) -> Outcome {
    let time = match size {
        Size::Quick => 5e-4,
        Size::Full => 2.5e-3,
    };
    let mut rows = Vec::new();
    for share in [0.5, 0.9] {
        let angle = libm::atan(share * MU);
        let x = Block::new(size, method, weight(angle), 0.0, MU)?.slide_until(time);
        // the distance of a block without friction is the scale
        let free = 0.5 * GRAVITY * libm::sin(angle) * time * time;
        let held = f64::max(2.0, 0.5 / (1.0 - share)) * elastic_displacement(method);
        rows.push(Row::new(
            format!("tan(angle) = {share} mu: x over that without friction"),
            [0.0, x / free],
            1.0,
            (held / free, FROM),
            "sticks for tan(angle) < mu",
        ));
    }
    for share in [1.2, 2.0] {
        let angle = libm::atan(share * MU);
        let acceleration = GRAVITY * (libm::sin(angle) - MU * libm::cos(angle));
        let x = Block::new(size, method, weight(angle), 0.0, MU)?.slide_until(time);
        let exact = 0.5 * acceleration * time * time;
        let d = elastic_displacement(method);
        let ahead = (2.0 * GRAVITY * libm::sin(angle) * d).sqrt() * time + SUDDEN * d;
        rows.push(Row::new(
            format!("tan(angle) = {share} mu: 2 x/t^2 (m/s^2)"),
            [acceleration, 2.0 * x / (time * time)],
            acceleration,
            (ahead / exact, FROM),
            "g (sin(angle) - mu cos(angle))",
        ));
    }
    Ok(rows)
}

fn weight(angle: f64) -> Vector3<f64> {
    GRAVITY * Vector3::new(libm::sin(angle), 0.0, -libm::cos(angle))
}

/// d = mu p/k_t + mu rho g H^2/(2G) (m).
fn elastic_displacement(method: Method) -> f64 {
    let pressure = MATERIAL.density * GRAVITY * BLOCK[2];
    let spring = match method {
        Method::Penalty => MU * pressure / SPRING,
        Method::Exact(_) | Method::Implicit { .. } => 0.0,
    };
    spring + MU * pressure * BLOCK[2] / (2.0 * MATERIAL.shear())
}

struct Block {
    simulation: Simulation,
    /// Masses of its nodes and their sum (kg).
    masses: Vec<f64>,
    mass: f64,
    /// Its nodes on the plane.
    base: Vec<u32>,
    /// Whether [`Block::slide_until`] ends with the step that passes the time.
    every_step: bool,
}

impl Block {
    /// A block on the plane z = 0 that has settled under its weight, sliding at `speed` along x.
    fn new(
        size: Size,
        method: Method,
        acceleration: Vector3<f64>,
        speed: f64,
        mu: f64,
    ) -> Result<Self, Cause> {
        let cells = match size {
            Size::Quick => [4, 2, 1],
            Size::Full => [8, 4, 2],
        };
        let block = mesh::block(cells, BLOCK);
        let h = BLOCK[0] / cells[0] as f64;
        // meshes that do not match, for which mortar constraints are meant
        let pitch = if method == Method::Exact(Rows::Mortar) { 0.8 } else { 1.0 };
        let cells_along = |length: f64| (length / (pitch * h)).round() as usize;
        let plane_cells = [cells_along(PLANE), cells_along(BLOCK[1]), 1];
        let mut plane = mesh::block(plane_cells, [PLANE, BLOCK[1], h]);
        plane.nodes.iter_mut().for_each(|x| *x -= Vector3::new(BLOCK[0], 0.0, h));
        let mesh = mesh::join(&[block, plane]);

        let down = Vector3::new(0.0, 0.0, acceleration.z);
        let (mut settling, contact) = setup(&mesh, down, 1.0, mu)?;
        settling.system.contact = Some(match method {
            Method::Penalty => contact.into(),
            Method::Exact(rows) => exact(&mesh, rows, mu)?.into(),
            Method::Implicit { .. } => exact(&mesh, Rows::NodeToFace, mu)?.into(),
        });
        let pressure = -down[2] * MATERIAL.density * BLOCK[2];
        let body = mesh.bodies[0].nodes.clone();
        match method {
            Method::Penalty => {
                let pressed = Padded::new([0.0, 0.0, -pressure / SPRING]);
                settling.displacement[body.clone()].fill(pressed);
            }
            // critical for the column: omega = pi c/(2 H)
            Method::Exact(_) | Method::Implicit { .. } => {
                let c = (MATERIAL.young / MATERIAL.density).sqrt();
                settling.system.mass_damping = std::f64::consts::PI * c / BLOCK[2];
            }
        }
        let mut settling = Simulation::new(settling);
        while settling.time() < SETTLING {
            settling.step(false);
        }

        let (mut setup, mut contact) = setup(&mesh, acceleration, 0.1, mu)?;
        setup.displacement.copy_from_slice(settling.displacement());
        let dt = setup.dt;
        if let Method::Implicit { .. } = method {
            setup.velocity[body.clone()].fill(Padded::new([speed, 0.0, 0.0]));
        } else if speed > 0.0 {
            // the block slid before t = 0: contact needs the positions of the step before
            setup.velocity[body.clone()].fill(Padded::new([
                speed + 0.5 * dt * MU * GRAVITY,
                0.0,
                0.0,
            ]));
            let mut before = setup.displacement.clone();
            before[body.clone()].iter_mut().for_each(|u| u.0[0] -= dt * speed);
            let at = contact.trace().positions(setup.system.solid.reference(), &before);
            contact.apply_frictionless(&at, &mut vec![Padded::ZERO; at.len()]);
        }
        let contact: contact::Method = match method {
            Method::Penalty => contact.into(),
            Method::Exact(rows) => {
                setup.system.solid = damped(&mesh, 0.3 * setup.dt)?;
                exact(&mesh, rows, mu)?.into()
            }
            Method::Implicit { longer, .. } => {
                setup.system.solid = damped(&mesh, 0.3 * setup.dt)?;
                setup.dt *= longer;
                exact(&mesh, Rows::NodeToFace, mu)?.into()
            }
        };
        setup.system.contact = Some(contact);
        let masses = setup.system.mass[body].to_vec();
        let mass = masses.iter().sum();
        let base = side_nodes(&mesh, 0, "z-").to_vec();
        let mut simulation = Simulation::new(setup);
        if let Method::Implicit { theta, .. } = method {
            simulation.set_implicit(theta);
        }
        let every_step = matches!(method, Method::Implicit { .. });
        Ok(Self { simulation, masses, mass, base, every_step })
    }

    /// Steps to the time `t` (the centre of mass is interpolated within the last step, which would matter with long ones) and returns
    /// the displacement of the centre of mass along x (m).
    fn slide_until(&mut self, t: f64) -> f64 {
        let mut before = (self.simulation.time(), self.centre());
        let mut now = before;
        while now.0 < t {
            self.simulation.step(false);
            before = now;
            now = (self.simulation.time(), self.centre());
        }
        if self.every_step {
            return now.1;
        }
        let share = if now.0 > before.0 { (t - before.0) / (now.0 - before.0) } else { 1.0 };
        before.1 + share * (now.1 - before.1)
    }

    /// Mean displacement along x of the nodes on the plane (m).
    fn base_displacement(&self) -> f64 {
        let u = self.simulation.displacement();
        self.base.iter().map(|&n| u[n as usize].0[0]).sum::<f64>() / self.base.len() as f64
    }

    /// Displacement of the centre of mass along x (m).
    fn centre(&self) -> f64 {
        let u = self.simulation.displacement();
        self.masses.iter().zip(u).map(|(m, u)| m * u.0[0]).sum::<f64>() / self.mass
    }
}

/// Block and plane with Kelvin–Voigt damping (s).
fn damped(mesh: &Mesh, kelvin_voigt: f64) -> Result<Solid, Cause> {
    let viscosity = Viscosity { kelvin_voigt, ..Viscosity::default() };
    let element = Element { hourglass: 0.05 };
    Ok(Solid::new(mesh, &[MATERIAL; 2], element, viscosity, Level::detect())?)
}

fn exact(mesh: &Mesh, rows: Rows, mu: f64) -> Result<ExactContact, Cause> {
    let settings = ExactSettings { slave: Some(0), rows, ..ExactSettings::default() };
    let law = Box::new(Coulomb { mu });
    Ok(ExactContact::new(mesh, surfaces(mesh), &settings, law)?)
}

fn surfaces(mesh: &Mesh) -> [(&Surface, BodyMaterial); 2] {
    let material = contact_material(&MATERIAL);
    [&mesh.bodies[0].surfaces["z-"], &mesh.bodies[1].surfaces["z+"]].map(|s| (s, material))
}

/// Block and held plane at rest, and their contact with normal contact damping as a share of critical.
fn setup(
    mesh: &Mesh,
    acceleration: Vector3<f64>,
    damping: f64,
    mu: f64,
) -> Result<(Setup, PenaltyContact), Cause> {
    let settings = PenaltySettings {
        normal: Stiffness::Areal(SPRING),
        tangential: Stiffness::Areal(SPRING),
        damping,
        curvature: false,
        normals: Normals::Averaged,
    };
    let contact =
        PenaltyContact::new(mesh, surfaces(mesh), &settings, None, Box::new(Coulomb { mu }))?;
    let mut setup = at_rest(mesh, MATERIAL, 0.7, Some(&contact))?;
    setup.system.held = mesh.bodies[1].nodes.clone().map(|n| n as u32).collect();
    setup.system.load =
        Load::weight(&setup.system.mass, mesh.bodies[0].nodes.clone(), acceleration);
    Ok((setup, contact))
}
