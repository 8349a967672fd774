//! The discretised bodies of a scenario: mesh, masses, sets, elements and contact, as far as they follow from the
//! case without the preload.

use crate::case::friction_law;
use crate::case::schema::{Case, Enforcement};
use crate::scenario::error::ScenarioError;
use crate::scenario::wheel_on_rail::PositionReport;
use contact::{
    BodyMaterial, ExactContact, ExactSettings, GapFunction, Method, PenaltyContact,
    PenaltySettings, StabilityScale,
};
use friction::OwnLaw;
use mesh::{Face, Mesh, Padded, Surface};
use solid::{Element, Elements, Level, Material, Solid, Viscosity, Volumetric};
use std::sync::Arc;

/// Lanczos steps for the largest frequency, and the factor by which their result, a lower bound, is raised.
const LANCZOS: usize = 40;
const MARGIN: f64 = 1.01;

/// Index of the disk among bodies and contact sides.
pub const DISK: usize = 0;
/// Index of the bar among bodies and contact sides.
pub const BAR: usize = 1;

/// The discretised bodies of a disk on a bar: x along the rolling direction, z up, the first point of contact at
/// the origin.
pub struct Model {
    /// Both bodies in one mesh, the disk first; nodes in m.
    pub mesh: Mesh,
    /// Where a wheel with profiles touches the rail, and what it slips by that.
    pub position: Option<PositionReport>,
    /// Remarks on a mesh file for the user, one sentence each; none for a generated mesh.
    pub notes: Vec<String>,
    /// Materials of the disk and of the bar.
    pub materials: [Material; 2],
    pub(crate) element: Element,
    /// Which elements are fully integrated, one entry per element; empty where none is.
    pub(crate) full: Vec<bool>,
    pub(crate) volumetric: Volumetric,
    /// Instruction set of the element kernels.
    pub kernels: Level,
    /// The function of `friction.law = "python"`, which is no part of the case.
    pub law: Option<Arc<dyn OwnLaw>>,
    /// How many parts alike make up the bodies: 2 for half a model, whose forces, masses and energies are those of
    /// one part.
    pub multiplicity: f64,
    /// Nodes that do not move along y: those on a plane of symmetry, or all of a slice in plane strain.
    pub sliding: Vec<u32>,
    /// Pairs of nodes that face each other across a slice in plane strain and move as one, ascending by the first;
    /// empty in three dimensions.
    pub paired: Vec<[u32; 2]>,
    /// Lumped mass of each node (kg), also of those that are held.
    pub mass: Vec<f64>,
    /// The whole contact surfaces, of the disk and of the bar.
    pub surfaces: [Surface; 2],
    /// Their faces in the fine zone, which contact output records.
    pub zones: [Vec<Face>; 2],
    /// Nodes of the rigid hub.
    pub hub: Vec<u32>,
    /// Clamped nodes: the bar's bottom.
    pub clamped: Vec<u32>,
    /// End faces of the bar if they are quiet.
    pub quiet: Vec<Surface>,
}

impl Model {
    /// How the elements are integrated.
    pub fn elements(&self) -> Elements<'_> {
        Elements::mixed(self.element, &self.full, self.volumetric)
    }

    /// Number of fully integrated elements.
    pub fn fully_integrated(&self) -> usize {
        self.full.iter().filter(|full| **full).count()
    }

    /// The elements, ready to give forces.
    ///
    /// # Errors
    /// A material without a wave speed, elements that are inverted, kernels that this machine does not have.
    pub fn solid(&self, case: &Case) -> Result<Solid, ScenarioError> {
        let viscosity = Viscosity {
            bulk_linear: case.damping.bulk_linear,
            bulk_quadratic: case.damping.bulk_quadratic,
            kelvin_voigt: case.kelvin_voigt(),
        };
        Ok(Solid::new(&self.mesh, &self.materials, self.elements(), viscosity, self.kernels)?)
    }

    /// Inverse mass of each node (1/kg), zero for clamped nodes and for those of the hub.
    pub(crate) fn inverse_mass(&self) -> Vec<f64> {
        let mut inverse: Vec<f64> = self.mass.iter().map(|m| 1.0 / m).collect();
        self.clamped.iter().chain(&self.hub).for_each(|&n| inverse[n as usize] = 0.0);
        inverse
    }

    /// Largest angular frequency (rad/s) of a stiffness, of which `add_product` adds the product with x to y, with a
    /// margin of one per cent; of half a model that of the motions that its plane admits.
    pub(crate) fn largest_frequency(
        &self,
        mut add_product: impl FnMut(&[Padded], &mut [Padded]),
    ) -> f64 {
        let inverse_mass = self.inverse_mass();
        if self.multiplicity == 1.0 {
            return MARGIN * solid::largest_frequency(&inverse_mass, add_product, LANCZOS);
        }
        let slide = |field: &mut [Padded]| {
            self.sliding.iter().for_each(|&n| field[n as usize][1] = 0.0);
        };
        let mut slid = vec![Padded::ZERO; inverse_mass.len()];
        let product = |x: &[Padded], y: &mut [Padded]| {
            slid.copy_from_slice(x);
            slide(&mut slid);
            add_product(&slid, y);
            slide(y);
        };
        MARGIN * solid::largest_frequency(&inverse_mass, product, LANCZOS)
    }

    /// Largest angular frequency of the bodies without contact (rad/s), with a margin of one per cent.
    pub fn elastic_frequency(&self, solid: &mut Solid) -> f64 {
        self.largest_frequency(|x, y| solid.add_stiffness_product(x, y))
    }

    /// Penalty contact of disk and bar, not yet in touch. `scale` is what springs that are given as a fraction of
    /// the stability limit are a fraction of.
    ///
    /// # Errors
    /// A friction law or settings that the contact refuses, or surfaces that cannot be used.
    pub fn penalty_contact(
        &self,
        case: &Case,
        scale: StabilityScale,
    ) -> Result<PenaltyContact, ScenarioError> {
        let settings = PenaltySettings {
            normal: case.contact.penalty.normal,
            tangential: case.contact.penalty.tangential,
            damping: case.contact.penalty.damping,
            curvature: case.contact.curvature,
            normals: case.contact.normals,
        };
        let law = friction_law::law(case, self.law.as_ref())?;
        Ok(PenaltyContact::new(&self.mesh, self.sides(), &settings, Some(scale), law)?)
    }

    /// Exact contact of disk and bar, by Lagrange multipliers, not yet in touch.
    ///
    /// # Errors
    /// As those of [`Model::penalty_contact`].
    pub fn exact_contact(&self, case: &Case) -> Result<ExactContact, ScenarioError> {
        let law = friction_law::law(case, self.law.as_ref())?;
        Ok(ExactContact::new(&self.mesh, self.sides(), &self.exact_settings(case), law)?)
    }

    /// Contact as the case enforces it, for its nodes and their areas alone: springs that are a fraction of the stability
    /// limit, which only a preload gives, have no stiffness of meaning.
    ///
    /// # Errors
    /// As those of [`Model::penalty_contact`].
    pub fn contact_nodes(&self, case: &Case) -> Result<Method, ScenarioError> {
        Ok(match case.contact.enforcement {
            Enforcement::Exact => self.exact_contact(case)?.into(),
            Enforcement::Penalty => {
                let any = StabilityScale { omega_elastic: 1.0, dt: 1.0 };
                self.penalty_contact(case, any)?.into()
            }
        })
    }

    /// The gaps between slave nodes and the other surface that exact contact constrains.
    ///
    /// # Errors
    /// Surfaces that cannot be used.
    pub fn gaps(&self, case: &Case) -> Result<GapFunction, ScenarioError> {
        Ok(GapFunction::new(&self.mesh, self.sides(), &self.exact_settings(case))?)
    }

    fn exact_settings(&self, case: &Case) -> ExactSettings {
        ExactSettings {
            slave: Some(self.slave()),
            curvature: case.contact.curvature,
            normals: case.contact.normals,
            rows: case.contact.rows.unwrap_or_default(),
        }
    }

    /// The side whose nodes are slaves of exact contact: that of the finer zone, the disk's where both
    /// are alike.
    pub fn slave(&self) -> usize {
        contact::finer([DISK, BAR].map(|side| {
            let area = |f: &Face| {
                let corners = f.nodes.map(|n| self.mesh.nodes[n as usize]);
                mesh::quad_corner_areas(&corners).iter().sum::<f64>()
            };
            self.zones[side].iter().map(area).sum::<f64>() / self.zones[side].len() as f64
        }))
    }

    fn sides(&self) -> [(&Surface, BodyMaterial); 2] {
        let body = |m: Material| BodyMaterial { bulk_modulus: m.bulk(), density: m.density };
        [DISK, BAR].map(|side| (&self.surfaces[side], body(self.materials[side])))
    }
}
