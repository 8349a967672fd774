//! The deformation in `fields.vtkhdf`: displacement without the body's rigid motion.

use runs::small;

const DISK: f64 = 0.0;
const BAR: f64 = 1.0;

fn rms(vectors: &[[f64; 3]]) -> f64 {
    let squares: f64 = vectors.as_flattened().iter().map(|x| x * x).sum();
    (squares / vectors.len() as f64).sqrt()
}

#[test]
fn a_hundredfold_deformation_leaves_the_wheel_in_its_place_and_the_two_dents_face_each_other() {
    // free rolling: traction would shift the two dents against each other, a hundredfold too
    let run = small(&["time.roll=0.004", "output.fields_interval=2e-5", "drive.creepage=0"]);
    let steps = run.data["fields/time"].len();
    let at_end = |name: &str| -> Vec<[f64; 3]> {
        run.data[&format!("fields/{name}/{:04}", steps - 1)].as_chunks().0.to_vec()
    };
    let points: Vec<[f64; 3]> = run.data["fields/points"].as_chunks().0.to_vec();
    let (displacement, deformation) = (at_end("displacement"), at_end("deformation"));
    let nodes_of = |body: f64| -> Vec<usize> {
        let cells = run.data["fields/cells"].chunks(8).zip(&run.data["fields/body/0000"]);
        let own = cells.filter(|(_, label)| **label == body).flat_map(|(cell, _)| cell);
        let mut nodes: Vec<usize> = own.map(|node| *node as usize).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    };
    let (disk, bar) = (nodes_of(DISK), nodes_of(BAR));
    let of =
        |field: &[[f64; 3]], nodes: &[usize]| nodes.iter().map(|&n| field[n]).collect::<Vec<_>>();

    assert_eq!(of(&deformation, &bar), of(&displacement, &bar));
    let (whole, own) = (rms(&of(&displacement, &disk)), rms(&of(&deformation, &disk)));
    assert!(
        whole > 3e-3 && own > 1e-7 && own < 2e-5,
        "{whole} m of rolling, {own} m of deformation"
    );
    let radius = |n: &&usize| points[**n][0].hypot(points[**n][2] - 0.08);
    let hub: Vec<usize> = disk.iter().filter(|n| radius(n) < 0.0501).copied().collect();
    assert!(!hub.is_empty() && of(&deformation, &hub).as_flattened().iter().all(|d| *d == 0.0));

    // ParaView: Warp By Vector with displacement + 99 deformation
    let magnified =
        |n: usize, i: usize| points[n][i] + displacement[n][i] + 99.0 * deformation[n][i];
    let by_depth = |a: &&usize, b: &&usize| deformation[**a][2].total_cmp(&deformation[**b][2]);
    let dent = *disk.iter().max_by(by_depth).unwrap();
    let deepest = *bar.iter().min_by(by_depth).unwrap();
    let hub_x = *run.history("hub_x").last().unwrap();
    for (node, body) in [(dent, "disk"), (deepest, "bar")] {
        let away = magnified(node, 0) - hub_x;
        assert!(away.abs() < 1e-3, "the dent of the {body} is {away} m from the hub");
    }
    let apart = magnified(dent, 0) - magnified(deepest, 0);
    assert!(apart.abs() < 0.8e-3, "the dents are {apart} m apart, more than an element");
    // they touch as they are, and magnified each has moved off by 99 times its depth
    let gap = magnified(dent, 2) - magnified(deepest, 2);
    let depths = 99.0 * (deformation[dent][2] - deformation[deepest][2]);
    assert!((gap - depths).abs() < 5e-5 && depths > 1e-3, "{gap} {depths}");
    // the wheel keeps its size, which it does not where its rolling is magnified too
    let height = |z: &dyn Fn(usize) -> f64| {
        let ends = disk.iter().map(|&n| z(n));
        ends.clone().fold(f64::MIN, f64::max) - ends.fold(f64::MAX, f64::min)
    };
    let kept = height(&|n| magnified(n, 2)) / 0.16;
    let swollen = height(&|n| points[n][2] + 100.0 * displacement[n][2]) / 0.16;
    assert!((kept - 1.0).abs() < 0.05 && swollen > 2.0, "{kept} {swollen}");
}
