//! The outside of a mesh of hexahedra.

/// Corners of the faces of a hexahedron, in the order of VTK.
const FACES: [[usize; 4]; 6] =
    [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [2, 3, 7, 6], [1, 2, 6, 5], [0, 4, 7, 3]];

/// The faces that one cell alone has, among the cells that `keep` takes by their index.
pub(super) fn skin(cells: &[[u32; 8]], keep: impl Fn(usize) -> bool) -> Vec<[u32; 4]> {
    let kept = cells.iter().enumerate().filter(|(i, _)| keep(*i));
    let mut faces: Vec<([u32; 4], [u32; 4])> = kept
        .flat_map(|(_, cell)| FACES.map(|face| face.map(|corner| cell[corner])))
        .map(|face| {
            let mut sorted = face;
            sorted.sort_unstable();
            (sorted, face)
        })
        .collect();
    faces.sort_unstable();
    let alone = faces.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() == 1);
    alone.flatten().map(|(_, face)| *face).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_cells_have_ten_faces_and_not_the_one_between_them() {
        // side by side along x, which share the nodes 1, 2, 5, 6
        let cells = [[0, 1, 2, 3, 4, 5, 6, 7], [1, 8, 9, 2, 5, 10, 11, 6]];
        let both = skin(&cells, |_| true);
        assert_eq!(both.len(), 10);
        let shared = |face: &[u32; 4]| face.iter().all(|node| [1, 2, 5, 6].contains(node));
        assert!(!both.iter().any(shared));
        let one = skin(&cells, |i| i == 0);
        assert!(one.len() == 6 && one.iter().any(shared));
        assert!(skin(&cells, |_| false).is_empty());
    }
}
