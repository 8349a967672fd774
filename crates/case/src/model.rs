//! A case's mesh, masses and sets: all that follows from geometry and material alone.

use crate::friction_law;
use crate::memory::enough_for_mesh;
use crate::mesh_file;
use crate::run_error::RunError;
use crate::schema::{Case, ContactLayers, Ends};
use crate::validation::LAYERS;
use contact::{
    BodyMaterial, ExactContact, ExactSettings, GapFunction, PenaltyContact, PenaltySettings,
    StabilityScale,
};
use friction::OwnLaw;
use mesh::{Face, Mesh, Surface};
use solid::{Element, Elements, Level, Material, Solid, Viscosity, Volumetric};
use std::sync::Arc;

/// Index of the disk among bodies and contact sides.
pub(crate) const DISK: usize = 0;
/// Index of the bar among bodies and contact sides.
pub(crate) const BAR: usize = 1;

/// The discretised bodies.
pub(crate) struct Model {
    pub(crate) mesh: Mesh,
    /// What is to be said of a mesh file, a sentence each.
    pub(crate) notes: Vec<String>,
    pub(crate) materials: [Material; 2],
    element: Element,
    /// Which elements are fully integrated, one entry per element; empty where none is.
    full: Vec<bool>,
    volumetric: Volumetric,
    /// Instruction set of the element kernels.
    pub(crate) kernels: Level,
    /// The friction law that was handed over with the run.
    pub(crate) law: Option<Arc<dyn OwnLaw>>,
    /// Nodes that face each other across a slice in plane strain and move as one; empty in space.
    pub(crate) paired: Vec<[u32; 2]>,
    /// Lumped masses (kg).
    pub(crate) mass: Vec<f64>,
    /// The whole contact surfaces.
    pub(crate) surfaces: [Surface; 2],
    /// Their faces in the fine zone, which contact output records.
    pub(crate) zones: [Vec<Face>; 2],
    /// Nodes of the rigid hub.
    pub(crate) hub: Vec<u32>,
    /// Clamped nodes: the bar's bottom.
    pub(crate) clamped: Vec<u32>,
    /// End faces of the bar if they are quiet.
    pub(crate) quiet: Vec<Surface>,
}

impl Model {
    /// Builds the meshes of a case.
    pub(crate) fn build(case: &Case) -> Result<Self, RunError> {
        enough_for_mesh(case)?;
        let (mut mesh, notes) = match mesh_file::import(case)? {
            Some(imported) => imported,
            None => (generated(case)?, Vec::new()),
        };
        let materials = [material(case.disk_material()), material(case.bar_material())];
        let paired = if case.mesh.plane_strain { align(&mut mesh)? } else { Vec::new() };
        let mut mass = solid::lumped_mass(&mesh, &materials.map(|m| m.density));
        for pair in &paired {
            let [a, b] = pair.map(|n| n as usize);
            mass[a] = 0.5 * (mass[a] + mass[b]);
            mass[b] = mass[a];
        }
        let surface = |body: usize, name: &str| {
            mesh.bodies[body].surfaces.get(name).cloned().unwrap_or_default()
        };
        let set = |body: usize, name: &str| {
            mesh.bodies[body].node_sets.get(name).cloned().unwrap_or_default()
        };
        let quiet = match case.bar.ends {
            Ends::Quiet => vec![surface(BAR, "rear"), surface(BAR, "front")],
            Ends::Free => Vec::new(),
        };
        Ok(Self {
            materials,
            element: Element { hourglass: case.element.hourglass },
            full: fully_integrated(case, &mesh),
            volumetric: match case.element.volumetric.unwrap_or_default() {
                crate::schema::Volumetric::Mean => Volumetric::Mean,
                crate::schema::Volumetric::Full => Volumetric::Full,
            },
            kernels: if case.deterministic { Level::pinned() } else { Level::detect() },
            law: None,
            paired,
            mass,
            surfaces: [surface(DISK, "tread"), surface(BAR, "top")],
            zones: [surface(DISK, "zone").faces, surface(BAR, "zone").faces],
            hub: set(DISK, "hub"),
            clamped: set(BAR, "bottom"),
            quiet,
            mesh,
            notes,
        })
    }

    /// How the elements are integrated.
    pub(crate) fn elements(&self) -> Elements<'_> {
        Elements::mixed(self.element, &self.full, self.volumetric)
    }

    /// Number of fully integrated elements.
    pub(crate) fn fully_integrated(&self) -> usize {
        self.full.iter().filter(|full| **full).count()
    }

    /// The elements.
    pub(crate) fn solid(&self, case: &Case) -> Result<Solid, RunError> {
        let viscosity = Viscosity {
            bulk_linear: case.damping.bulk_linear,
            bulk_quadratic: case.damping.bulk_quadratic,
            kelvin_voigt: case.damping.kelvin_voigt,
        };
        Ok(Solid::new(&self.mesh, &self.materials, self.elements(), viscosity, self.kernels)?)
    }

    /// Penalty contact of disk and bar.
    pub(crate) fn penalty_contact(
        &self,
        case: &Case,
        scale: StabilityScale,
    ) -> Result<PenaltyContact, RunError> {
        let settings = PenaltySettings {
            normal: stiffness(case.contact.penalty.normal),
            tangential: stiffness(case.contact.penalty.tangential),
            damping: case.contact.penalty.damping,
            curvature: case.contact.curvature,
        };
        let law = friction_law::law(case, self.law.as_ref())?;
        Ok(PenaltyContact::new(&self.mesh, self.sides(), &settings, Some(scale), law)?)
    }

    /// Exact contact of disk and bar.
    pub(crate) fn exact_contact(&self, case: &Case) -> Result<ExactContact, RunError> {
        let law = friction_law::law(case, self.law.as_ref())?;
        Ok(ExactContact::new(&self.mesh, self.sides(), &self.exact_settings(case), law)?)
    }

    /// The gaps that exact contact closes.
    pub(crate) fn gaps(&self, case: &Case) -> Result<GapFunction, RunError> {
        Ok(GapFunction::new(&self.mesh, self.sides(), &self.exact_settings(case))?)
    }

    fn exact_settings(&self, case: &Case) -> ExactSettings {
        ExactSettings {
            slave: Some(self.slave()),
            curvature: case.contact.curvature,
            rows: match case.contact.rows.unwrap_or_default() {
                crate::schema::Rows::NodeToFace => contact::Rows::NodeToFace,
                crate::schema::Rows::Mortar => contact::Rows::Mortar,
            },
        }
    }

    /// The side whose nodes are slaves of exact contact: that of the finer zone, the disk's where both
    /// are alike.
    pub(crate) fn slave(&self) -> usize {
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

/// Elements of the mesh of a case.
///
/// # Errors
/// A mesh that cannot be made.
pub fn elements(case: &Case) -> Result<usize, RunError> {
    Ok(Model::build(case)?.mesh.hexes.len())
}

/// The meshes of the shapes that a case gives.
fn generated(case: &Case) -> Result<Mesh, RunError> {
    let (mut disk, mut bar) = (case.disk.shape(), case.bar.shape());
    let mut zone = case.mesh.fine_zone();
    let stretch = zone.width / zone.size;
    if case.mesh.plane_strain {
        // a slice is made one cube wide and stretched to its width
        (disk.width, bar.width, zone.width) = (zone.size, zone.size, zone.size);
    }
    let mut mesh = mesh::join(&[mesh::disk(&disk, &zone)?, mesh::bar(&bar, &zone)?]);
    if case.mesh.plane_strain {
        mesh.nodes.iter_mut().for_each(|x| x[1] *= stretch);
    }
    Ok(mesh)
}

/// The pairs of nodes across a slice, whose second nodes are put exactly across from the first.
fn align(mesh: &mut Mesh) -> Result<Vec<[u32; 2]>, mesh::NoSlice> {
    let pairs = mesh::across(mesh)?;
    for &[first, second] in &pairs {
        let [x, _, z] = mesh.nodes[first as usize];
        let [ox, _, oz] = &mut mesh.nodes[second as usize];
        (*ox, *oz) = (x, z);
    }
    Ok(pairs)
}

/// The elements in the contact layers of the fine zones, if they are to be fully integrated.
fn fully_integrated(case: &Case, mesh: &Mesh) -> Vec<bool> {
    if case.element.contact_layers == ContactLayers::OnePoint {
        return Vec::new();
    }
    let layers = case.element.layers.unwrap_or(LAYERS) as usize;
    let mut full = vec![false; mesh.hexes.len()];
    for body in &mesh.bodies {
        let faces = body.surfaces.get("zone").map_or(&[][..], |zone| &zone.faces);
        let below = mesh::layers_below(mesh, body, faces, layers);
        below.into_iter().for_each(|e| full[e as usize] = true);
    }
    full
}

fn material(m: crate::schema::Material) -> Material {
    Material { young: m.young, poisson: m.poisson, density: m.density }
}

pub(crate) fn stiffness(s: crate::schema::Stiffness) -> contact::PenaltyStiffness {
    match s {
        crate::schema::Stiffness::Factor(v) => contact::PenaltyStiffness::Scale(v),
        crate::schema::Stiffness::Areal(v) => contact::PenaltyStiffness::Areal(v),
        crate::schema::Stiffness::Stability(v) => contact::PenaltyStiffness::StabilityFraction(v),
    }
}
