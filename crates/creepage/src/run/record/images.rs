//! The recorded surfaces as wholes: where half of the bodies is modelled, their nodes have mirror images in y = 0.

use nalgebra::Vector3;

/// Which nodes of a table of each side have mirror images; none where the bodies are modelled whole.
pub(super) struct Images {
    /// How many rows each table has.
    rows: [usize; 2],
    /// The rows of each table that have an image, ascending.
    imaged: [Vec<u32>; 2],
}

impl Images {
    /// Of tables with these undeformed positions (m) of nodes, of `half` the bodies or of whole ones.
    pub(super) fn new(half: bool, points: &[Vec<Vector3<f64>>; 2]) -> Self {
        let off_plane = |points: &Vec<Vector3<f64>>| {
            let rows = 0..points.len() as u32;
            rows.filter(|&row| half && points[row as usize][1] != 0.0).collect()
        };
        Self { rows: points.each_ref().map(Vec::len), imaged: points.each_ref().map(off_plane) }
    }

    /// How many nodes there are of each side with the images.
    pub(super) fn counts(&self) -> [usize; 2] {
        [0, 1].map(|side| self.rows[side] + self.imaged[side].len())
    }

    /// Values of a side with those of the images.
    pub(super) fn of_side<T: Copy, U: From<T>>(
        &self,
        side: usize,
        values: &[T],
        image: fn(T) -> T,
        whole: &mut Vec<U>,
    ) {
        whole.extend(values.iter().map(|&value| U::from(value)));
        whole.extend(self.imaged[side].iter().map(|&row| U::from(image(values[row as usize]))));
    }

    /// Values of both sides, each with those of its images after it.
    fn both<T: Copy, U: From<T>>(&self, values: [&[T]; 2], image: fn(T) -> T) -> Vec<U> {
        let mut whole = Vec::with_capacity(self.counts().iter().sum());
        for (side, values) in values.into_iter().enumerate() {
            self.of_side(side, values, image, &mut whole);
        }
        whole
    }

    /// Scalars of both sides.
    pub(super) fn scalars<T: Copy>(&self, values: [&[T]; 2]) -> Vec<T> {
        self.both(values, |value| value)
    }

    /// Vectors of both sides, as rows of a file.
    pub(super) fn vectors(&self, values: [&[Vector3<f64>]; 2]) -> Vec<[f64; 3]> {
        self.both(values, mirrored)
    }

    /// Areas of both sides (m^2): a node on the plane has half of its own.
    pub(super) fn areas(&self, values: [&[f64]; 2]) -> Vec<f64> {
        let mut whole = self.scalars(values);
        let mut first = 0;
        for (side, count) in self.counts().into_iter().enumerate() {
            if !self.imaged[side].is_empty() {
                let own = &mut whole[first..first + self.rows[side]];
                let on_plane = |row: usize| self.imaged[side].binary_search(&(row as u32)).is_err();
                for (_, area) in own.iter_mut().enumerate().filter(|(row, _)| on_plane(*row)) {
                    *area *= 2.0;
                }
            }
            first += count;
        }
        whole
    }

    /// The faces of a side with their images, which run the other way round; their nodes as rows of the whole side.
    pub(super) fn faces(&self, side: usize, faces: &[[u32; 4]]) -> Vec<[u32; 4]> {
        let image = |row: u32| match self.imaged[side].binary_search(&row) {
            Ok(place) => (self.rows[side] + place) as u32,
            Err(_) => row,
        };
        let images = faces.iter().map(|&[a, b, c, d]| [d, c, b, a].map(image));
        let count = if self.imaged[side].is_empty() { 0 } else { faces.len() };
        faces.iter().copied().chain(images.take(count)).collect()
    }
}

/// The mirror image of a vector in the plane y = 0.
pub(super) fn mirrored(v: Vector3<f64>) -> Vector3<f64> {
    Vector3::new(v.x, -v.y, v.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_half_of_a_face_and_its_image_share_the_edge_on_the_plane_and_look_the_same_way() {
        let points = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 2.0, 0.5], [0.0, 2.0, 0.5]];
        let vectors: Vec<_> = points.iter().copied().map(Vector3::from).collect();
        let images = Images::new(true, &[vectors.clone(), Vec::new()]);
        assert_eq!(images.counts(), [6, 0]);
        let whole = images.vectors([&vectors, &[]]);
        assert_eq!(whole[4..], [[1.0, -2.0, 0.5], [0.0, -2.0, 0.5]]);
        assert_eq!(images.faces(0, &[[0, 1, 2, 3]]), [[0, 1, 2, 3], [5, 4, 1, 0]]);
        assert_eq!(images.areas([&[1.0; 4], &[]]), [2.0, 2.0, 1.0, 1.0, 1.0, 1.0]);
        let alone = Images::new(false, &[vectors.clone(), Vec::new()]);
        assert_eq!(alone.vectors([&vectors, &[]]), points);
        assert_eq!(alone.areas([&[1.0; 4], &[]]), [1.0; 4]);
        assert_eq!(alone.faces(0, &[[0, 1, 2, 3]]), [[0, 1, 2, 3]]);
    }
}
