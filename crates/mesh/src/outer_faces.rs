//! The outside of a mesh of hexahedra.

use crate::HEX_FACES;

/// The faces that one element alone has among the elements that `keep` takes by their index: element and corners,
/// in the order of the elements and of [`HEX_FACES`].
pub fn outer_faces(hexes: &[[u32; 8]], keep: impl Fn(usize) -> bool) -> Vec<(usize, [u32; 4])> {
    let kept = (0..hexes.len()).filter(|element| keep(*element));
    let mut faces: Vec<([u32; 4], usize, usize)> = kept
        .flat_map(|element| (0..HEX_FACES.len()).map(move |side| (element, side)))
        .map(|(element, side)| {
            let mut nodes = HEX_FACES[side].map(|corner| hexes[element][corner]);
            nodes.sort_unstable();
            (nodes, element, side)
        })
        .collect();
    faces.sort_unstable();
    let alone = faces.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() == 1);
    let mut outer: Vec<(usize, usize)> =
        alone.flatten().map(|&(_, element, side)| (element, side)).collect();
    outer.sort_unstable();
    let corners = |(element, side): (usize, usize)| {
        (element, HEX_FACES[side].map(|corner| hexes[element][corner]))
    };
    outer.into_iter().map(corners).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Side by side along x; they share the nodes 1, 2, 5, 6.
    const TWO: [[u32; 8]; 2] = [[0, 1, 2, 3, 4, 5, 6, 7], [1, 8, 9, 2, 5, 10, 11, 6]];

    #[test]
    fn two_elements_have_ten_outer_faces_and_not_the_one_between_them() {
        let faces = outer_faces(&TWO, |_| true);
        assert_eq!(faces.len(), 10);
        let shared = |face: &[u32; 4]| face.iter().all(|node| [1, 2, 5, 6].contains(node));
        assert!(!faces.iter().any(|(_, face)| shared(face)));
        assert_eq!(faces.iter().filter(|(element, _)| *element == 0).count(), 5);
    }

    #[test]
    fn an_element_taken_alone_has_all_its_faces() {
        let faces = outer_faces(&TWO, |element| element == 1);
        assert_eq!(faces.len(), 6);
        assert!(faces.iter().all(|(element, _)| *element == 1));
        assert_eq!(faces[0].1, HEX_FACES[0].map(|corner| TWO[1][corner]));
    }
}
