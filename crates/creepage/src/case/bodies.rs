//! The keys of the two bodies and of their mesh.

use crate::case::form::Form::{Number, Text};
use crate::case::form::within;
use crate::case::forms::{Crown, ProfileShape};
use crate::case::irregularity::SurfaceHeights;
use crate::case::key::{
    ANGLE, BAR_HEIGHTS, CROWN, DENSITY, DISK_HEIGHTS, FLAG, LENGTH, POISSON, PROFILE, SET, YOUNG,
    key, word,
};
use crate::case::section::{is_default, section, words};

section! {
    /// The disk: an annulus with a rigid hub, rolling in +x.
    optional Disk {
        /// Rolling radius (m). Default 0.46.
        radius: f64 = 0.46 => LENGTH;
        /// Radius of the rigid hub (m). Default 0.10.
        hub_radius: f64 = 0.10 => LENGTH.finite_elements_only();
        /// Width in y (m). Default 0.06.
        width: f64 = 0.06 => LENGTH.finite_elements_only();
        /// Transverse radius of the tread (m), or `"flat"` for a straight tread. Default `"flat"`.
        crown_radius: Crown = Crown::Flat => CROWN.instead_of("disk.profile");
        /// Transverse profile in the place of a crown, that of the left wheel: y away from the middle of the track, z down, z = 0
        /// at `radius`. `"S1002"`, the path of a file (SIMPACK's .prw, or two columns in mm), or points in m. Default: none.
        profile: Option<ProfileShape> => PROFILE.instead_of("disk.crown_radius");
        /// Heights of the tread over its smooth shape (m), positive outward, over the angle (rad) from the first point of contact
        /// towards the material that touches later: flats, wheels out of round. `{ formula = "1e-4*cos(3*angle)" }`, with `angle`
        /// from -pi to pi, or `{ file = "wheel.csv" }` or `{ points = [[angle, height], ...] }`, linear between the points and from
        /// the last to the first after a turn. Default: none.
        out_of_round: Option<SurfaceHeights> => DISK_HEIGHTS;
        /// y of the wheel's profile over that of the bar (m). Default 0: their origins lie over one another.
        #[serde(skip_serializing_if = "is_default")]
        lateral: f64
            => key(Number(within(-1.0, 1.0)), "m", "give the shift in metres: 3e-3 for 3 mm");
        /// Angle of the disk about z (rad): yaw, on half-spaces. Default 0.
        #[serde(skip_serializing_if = "is_default")]
        yaw: f64 => ANGLE.half_space_only();
        /// Angle of the disk about x (rad): roll, on half-spaces. Default 0.
        #[serde(skip_serializing_if = "is_default")]
        roll: f64 => ANGLE.half_space_only();
        /// Height of the undeformed disk above touching at the start (m). Default 0. Above zero only
        /// with `preload.method = "none"`: a disk that does not touch cannot be preloaded.
        lift: f64
            => key(Number(within(0.0, 0.1)), "m", "leave it out: the disk then touches the bar at the start")
                .finite_elements_only();
        /// Material keys in which the disk differs from `[material]`. Default: none.
        #[serde(skip_serializing_if = "is_default")]
        material: MaterialOverride;
    }
}

impl Disk {
    /// The shape to mesh, where it has a crown and not a profile.
    pub fn shape(&self) -> mesh::Disk {
        mesh::Disk {
            radius: self.radius,
            hub_radius: self.hub_radius,
            width: self.width,
            crown: self.crown_radius.radius(),
        }
    }
}

section! {
    /// The bar: clamped at its bottom, its top's apex at z = 0.
    optional Bar {
        /// Length in x (m). Default 0.24.
        length: f64 = 0.24 => LENGTH.finite_elements_only();
        /// Width in y (m). Default 0.06.
        width: f64 = 0.06 => LENGTH.finite_elements_only();
        /// Height from the clamped bottom to the top's apex (m). Default 0.07.
        height: f64 = 0.07 => LENGTH.finite_elements_only();
        /// Transverse radius of the top (m), or `"flat"`. Default 0.30.
        crown_radius: Crown = Crown::Radius(0.30) => CROWN.instead_of("bar.profile");
        /// Transverse profile in the place of a crown, that of the left rail: y away from the middle of the track, z down.
        /// `"60E1"`, the path of a file (SIMPACK's .prr, or two columns in mm), or points in m. Default: none.
        profile: Option<ProfileShape> => PROFILE.instead_of("bar.crown_radius");
        /// Heights of the top over its smooth shape (m), positive up, over x (m) from the first point of contact at the start:
        /// corrugation, rough rails; or over x and y: squats. `{ formula = "1e-5*cos(2*pi*x/0.04)" }`, or `{ file = "rail.csv" }`
        /// of two or three columns, `{ points = [[x, height], ...] }` or `{ grid = [[x, y, height], ...] }`, linear between points
        /// that must cover the roll. Default: none.
        surface: Option<SurfaceHeights> => BAR_HEIGHTS;
        /// Angle about x (rad) by which a profile leans towards the middle of the track. Default 0.
        #[serde(skip_serializing_if = "is_default")]
        cant: f64 => ANGLE;
        /// x of the bar's rear end (m); rolling starts at x = 0. Default -0.09.
        start: f64 = -0.09
            => key(Number(within(-10.0, 10.0)), "m",
                "give x of the bar's rear end, negative: rolling starts at x = 0").finite_elements_only();
        /// `"quiet"` (Lysmer's viscous boundary, waves leave) or `"free"` ends. Default `"quiet"`.
        ends: Ends = Ends::Quiet => word(Ends::WORDS).finite_elements_only();
        /// Material keys in which the bar differs from `[material]`. Default: none.
        #[serde(skip_serializing_if = "is_default")]
        material: MaterialOverride;
    }
}

impl Bar {
    /// The shape to mesh, where it has a crown and not a profile.
    pub fn shape(&self) -> mesh::Bar {
        mesh::Bar {
            length: self.length,
            width: self.width,
            height: self.height,
            crown: self.crown_radius.radius(),
            start: self.start,
        }
    }
}

words! {
    /// The two ends of the bar.
    Ends {
        /// Lysmer's viscous boundary: waves leave the model.
        #[default]
        Quiet = "quiet",
        /// No traction: waves are reflected.
        Free = "free",
    }
}

section! {
    /// An isotropic elastic material.
    #[derive(Copy)]
    optional Material {
        /// Young's modulus (Pa). Default 210e9.
        young: f64 = 210e9 => YOUNG;
        /// Poisson's ratio (dimensionless). Default 0.3.
        poisson: f64 = 0.3 => POISSON;
        /// Density (kg/m^3). Default 7800.
        density: f64 = 7800.0 => DENSITY;
    }
}

impl Material {
    /// Speed of pressure waves (m/s).
    pub fn pressure_wave(&self) -> f64 {
        let Self { young, poisson, density } = *self;
        let modulus = young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
        (modulus / density).sqrt()
    }
}

section! {
    /// Those keys of a [`Material`] in which one body differs.
    #[derive(Copy)]
    optional MaterialOverride {
        /// Young's modulus of this body (Pa). Default: `material.young`.
        young: Option<f64> => YOUNG;
        /// Poisson's ratio of this body (dimensionless). Default: `material.poisson`.
        poisson: Option<f64> => POISSON;
        /// Density of this body (kg/m^3). Default: `material.density`.
        density: Option<f64> => DENSITY;
    }
}

impl MaterialOverride {
    /// These keys over those of `[material]`.
    pub fn over(&self, common: Material) -> Material {
        Material {
            young: self.young.unwrap_or(common.young),
            poisson: self.poisson.unwrap_or(common.poisson),
            density: self.density.unwrap_or(common.density),
        }
    }
}

section! {
    /// The mesh: a fine zone where contact passes, graded to coarse elements elsewhere; or a file.
    optional Meshing {
        /// Mesh of another program, relative to this file: Gmsh `.msh`, Abaqus `.inp`, `.vtu`, or `.vtkhdf`; `.med` and
        /// others through meshio (`pip install 'creepage[mesh]'`). `[disk]`, `[bar]` and `mesh.zone` then say what the
        /// mesh is, and must agree with it; `growth`, `coarsest` and `zone.depth` are without meaning. Default: the
        /// mesh is generated.
        file: Option<String>
            => key(Text, "",
                "give the path of a mesh file (.msh, .inp, .vtu, .vtkhdf, .med, ...) in quotes, relative to the case file; with --set, \
         to the working directory").finite_elements_only();
        /// SHA-256 of the file, in hexadecimal. Written into the case of a run, so that no other mesh
        /// takes its place unseen. Default with `file`: that of the file.
        sha256: Option<String>
            => key(Text, "", "leave it out: it is written into the case of a run").only_with("mesh.file", &[])
                .finite_elements_only();
        /// Unit of the file's coordinates: `"m"`, `"cm"`, `"mm"` or `"in"`. Default with `file`: `"m"`.
        unit: Option<LengthUnit>
            => word(LengthUnit::WORDS).only_with("mesh.file", &[])
                .finite_elements_only();
        /// Names of the sets in the file.
        #[serde(skip_serializing_if = "is_default")]
        sets: MeshSets;
        /// Ratio of neighbouring element sizes outside the fine zone (dimensionless). Default 1.35.
        growth: f64 = 1.35
            => key(Number(within(1.05, 3.0)), "-",
                "give the ratio of neighbouring element sizes: 1.35 grades gently").finite_elements_only();
        /// Largest element size (m). Default 0.05.
        coarsest: f64 = 0.05 => LENGTH.finite_elements_only();
        /// How elements become larger outside the fine zone: `"tensor"` (rows and columns run through the
        /// whole body) or `"two_to_one"` (columns are merged 2:1 in all three directions, with elements close to
        /// cubes and about a third as many). Default without `file`: `"two_to_one"`, and `"tensor"` with `plane_strain`.
        grading: Option<Grading> => word(Grading::WORDS).finite_elements_only();
        /// Whether no node moves in y (true or false): plane strain, the contact of two cylinders, by a
        /// slice one element wide. Both bodies and the fine zone must then be flat across and of one
        /// width, which only scales the forces; one near that of the coarsest elements keeps these well
        /// shaped. Default false.
        plane_strain: bool => FLAG;
        /// What of the bodies is modelled: `"whole"`, or `"half"`, the part y >= 0 of bodies that y = 0 is a plane of
        /// symmetry of, for half the time and memory. Loads, masses and results remain those of the whole bodies;
        /// fluctuations that are not symmetric are suppressed. Default `"whole"`.
        symmetry: Symmetry => word(Symmetry::WORDS).finite_elements_only();
        /// Length (m) of a fine zone that follows the contact, in place of `zone.length` and `zone.start`: the mesh then moves
        /// along the bar and around the disk, the bar needs no room for the roll, time grows with the rolled distance and memory does
        /// not. At least three patches are sensible. Default: the fine zone stays, and is as long as
        /// the roll.
        window: Option<f64> => LENGTH;
        /// The fine zone.
        zone: Zone;
    }
}

impl Meshing {
    /// Where the fine zone begins and how long it is, along x (m): one that follows the contact lies about it.
    fn zone_place(&self) -> [f64; 2] {
        let Zone { size, length, start, .. } = self.zone;
        match self.window {
            Some(window) => {
                let length = (window / size - 1e-9).ceil() * size;
                [-0.5 * length, length]
            }
            None => [start, length],
        }
    }

    /// The two ends of the fine zone along x (m).
    pub fn zone_along(&self) -> [f64; 2] {
        let [start, length] = self.zone_place();
        [start, start + length]
    }

    /// How elements become larger outside the fine zone. Merging in three directions is of meshes that are generated,
    /// and of those that are more than a slice.
    pub fn grading(&self) -> Grading {
        let three_directions = self.file.is_none() && !self.plane_strain;
        self.grading.unwrap_or(if three_directions { Grading::TwoToOne } else { Grading::Tensor })
    }

    /// The fine zone and the grading around it.
    pub fn fine_zone(&self) -> mesh::FineZone {
        let Zone { size, width, depth, .. } = self.zone;
        let [start, length] = self.zone_place();
        mesh::FineZone {
            size,
            length,
            width,
            depth,
            start,
            growth: self.growth,
            coarsest: self.coarsest,
            grading: match self.grading() {
                Grading::Tensor => mesh::Grading::Tensor,
                Grading::TwoToOne => mesh::Grading::TwoToOne,
            },
        }
    }
}

words! {
    /// What of the bodies is modelled.
    Symmetry {
        /// All of them.
        #[default]
        Whole = "whole",
        /// The part y >= 0.
        Half = "half",
    }
}

impl Symmetry {
    /// How many parts alike make up the bodies, of which one is modelled.
    pub fn multiplicity(self) -> f64 {
        match self {
            Self::Whole => 1.0,
            Self::Half => 2.0,
        }
    }
}

words! {
    /// How elements become larger outside the fine zone.
    Grading {
        /// Rows and columns run through the whole body.
        #[default]
        Tensor = "tensor",
        /// Columns are merged in all three directions.
        TwoToOne = "two_to_one",
    }
}

words! {
    /// A unit of length.
    LengthUnit {
        /// Metre.
        #[default]
        Metre = "m",
        /// Centimetre.
        Centimetre = "cm",
        /// Millimetre.
        Millimetre = "mm",
        /// Inch.
        Inch = "in",
    }
}

section! {
    /// Names of the sets in a mesh file.
    #[derive(Eq)]
    optional MeshSets {
        /// The disk's elements. Default with `mesh.file`: `"disk"`.
        disk: Option<String> => SET.finite_elements_only();
        /// The bar's elements. Default with `mesh.file`: `"bar"`.
        bar: Option<String> => SET.finite_elements_only();
        /// Nodes or faces of the rigid hub. Default with `mesh.file`: `"hub"`.
        hub: Option<String> => SET.finite_elements_only();
        /// Faces or nodes of the disk's running surface. Default with `mesh.file`: `"tread"`.
        tread: Option<String> => SET.finite_elements_only();
        /// Faces or nodes of the bar's running surface. Default with `mesh.file`: `"top"`.
        top: Option<String> => SET.finite_elements_only();
        /// Nodes or faces by which the bar is clamped. Default with `mesh.file`: `"clamp"`.
        clamp: Option<String> => SET.finite_elements_only();
    }
}

section! {
    /// The fine zone of both bodies.
    optional Zone {
        /// Element size in the fine zone (m); the one key that refines everything. Default 1e-3.
        size: f64 = 1e-3
            => key(Number(within(1e-9, 0.1)), "m", "give the element size in metres: 1e-3 for 1 mm");
        /// Length in x (m). Default 0.08.
        length: f64 = 0.08 => LENGTH;
        /// Width in y, centred on y = 0 (m). Default 0.02.
        width: f64 = 0.02 => LENGTH;
        /// Depth below the surface (m). Default 0.008.
        depth: f64 = 0.008 => LENGTH.finite_elements_only();
        /// x of the zone's rear end (m); rolling starts at x = 0. Default -0.010.
        start: f64 = -0.010
            => key(Number(within(-10.0, 10.0)), "m",
                "give x of the zone's rear end, negative: rolling starts at x = 0");
    }
}
