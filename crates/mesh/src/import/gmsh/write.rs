//! A mesh as an MSH file.

use super::super::foreign::Foreign;

/// The beginning of an MSH file that this program wrote.
pub const GMSH_MARK: &str =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Comments\nCreepage\n$EndComments\n";

/// A mesh as the text of an MSH file of format 2.2. Reading it again gives the same coordinates to the last bit.
///
/// The sets become physical groups: elements volumes, faces surfaces of quadrangles, nodes points. Nodes, and elements of
/// all kinds together, are numbered from 1. A hexahedron stands once for each set that it belongs to; one in no set is left
/// out.
pub fn write_gmsh(mesh: &Foreign) -> String {
    let mut text = String::from(GMSH_MARK);
    let mut names = Vec::new();
    let mut elements = Vec::new();
    let row = |corners: &[u32]| corners.iter().map(|n| format!(" {}", n + 1)).collect::<String>();
    let mut id = mesh.hexes.len();
    for (group, (name, set)) in (1..).zip(&mesh.sets) {
        let (faces, nodes) = (&set.faces, &set.nodes);
        let kinds = [(3, set.hexes.len()), (2, faces.len()), (0, nodes.len())];
        let given = kinds.iter().filter(|(_, members)| *members > 0);
        names.extend(given.map(|(dimension, _)| format!("{dimension} {group} \"{name}\"\n")));
        for &hex in &set.hexes {
            let corners = row(&mesh.hexes[hex as usize]);
            elements.push(format!("{} 5 2 {group} {group}{corners}\n", hex + 1));
        }
        for (kind, corners) in faces
            .iter()
            .map(|face| (3, face.as_slice()))
            .chain(nodes.iter().map(|node| (15, std::slice::from_ref(node))))
        {
            id += 1;
            elements.push(format!("{id} {kind} 2 {group} {group}{}\n", row(corners)));
        }
    }
    text += &format!("$PhysicalNames\n{}\n{}$EndPhysicalNames\n", names.len(), names.concat());
    text += &format!("$Nodes\n{}\n", mesh.points.len());
    for (n, p) in (1..).zip(&mesh.points) {
        text += &format!("{n} {:?} {:?} {:?}\n", p.x, p.y, p.z);
    }
    text + &format!("$EndNodes\n$Elements\n{}\n{}$EndElements\n", elements.len(), elements.concat())
}
