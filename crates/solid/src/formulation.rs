//! How the elements of a mesh are integrated.

/// Options of the one-point element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Element {
    /// Coefficient kappa of the hourglass stiffness of Flanagan and Belytschko (dimensionless); 0.05 is usual.
    pub hourglass: f64,
}

/// How the volumetric part of a fully integrated element is integrated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Volumetric {
    /// At every Gauss point, as the deviatoric part: locks as Poisson's ratio nears 1/2.
    Full,
    /// By the mean of tr E over the element (selective integration, mean dilatation): no volumetric locking.
    #[default]
    Mean,
}

/// How one element is integrated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Formulation {
    /// At one point, with hourglass stiffness.
    OnePoint(Element),
    /// At 2x2x2 Gauss points.
    Full(Volumetric),
}

impl From<Element> for Formulation {
    fn from(element: Element) -> Self {
        Self::OnePoint(element)
    }
}

impl From<Volumetric> for Formulation {
    fn from(volumetric: Volumetric) -> Self {
        Self::Full(volumetric)
    }
}

/// How each element of a mesh is integrated.
///
/// An [`Element`] converts into one-point elements throughout, a [`Volumetric`] into fully integrated ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elements<'a> {
    one_point: Element,
    volumetric: Volumetric,
    full: Selection<'a>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Selection<'a> {
    None,
    All,
    These(&'a [bool]),
}

impl<'a> Elements<'a> {
    /// Fully integrated elements where `full` is true, one-point elements elsewhere. `full` has one entry per element
    /// of the mesh; where it is shorter, the rest count as false.
    pub fn mixed(one_point: Element, full: &'a [bool], volumetric: Volumetric) -> Self {
        Self { one_point, volumetric, full: Selection::These(full) }
    }

    /// The formulation of an element, given by its index in the mesh.
    pub fn formulation(&self, element: usize) -> Formulation {
        if self.is_full(element) {
            Formulation::Full(self.volumetric)
        } else {
            Formulation::OnePoint(self.one_point)
        }
    }

    /// Whether an element, given by its index in the mesh, is fully integrated.
    pub fn is_full(&self, element: usize) -> bool {
        match self.full {
            Selection::None => false,
            Selection::All => true,
            Selection::These(full) => full.get(element).copied().unwrap_or(false),
        }
    }

    /// Options of the one-point elements.
    pub(crate) fn one_point(&self) -> Element {
        self.one_point
    }

    /// Option of the fully integrated elements.
    pub(crate) fn volumetric(&self) -> Volumetric {
        self.volumetric
    }
}

impl From<Element> for Elements<'_> {
    fn from(one_point: Element) -> Self {
        Self { one_point, volumetric: Volumetric::default(), full: Selection::None }
    }
}

impl From<Volumetric> for Elements<'_> {
    fn from(volumetric: Volumetric) -> Self {
        // No element uses the hourglass coefficient.
        Self { one_point: Element { hourglass: 0.0 }, volumetric, full: Selection::All }
    }
}
