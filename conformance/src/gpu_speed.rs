//! Eyes of many environments on a GPU, compared with MuJoCo's own renderer and MuJoCo Warp's.

mod others;
mod ours;

use std::path::PathBuf;
use std::rc::Rc;

use babybench::config::Scene;
use conformance::pictures::Difference;

use crate::python;

/// Rounds that are measured; their median is printed.
const ROUNDS: usize = 7;
/// Width and height of a picture.
const SIZE: usize = 64;
/// Values of a picture.
const PICTURE: usize = 3 * SIZE * SIZE;

/// A renderer with a number of environments: a row of the table.
struct Row {
    scene: String,
    renderer: String,
    /// Its device.
    device: String,
    environments: usize,
    /// Time of a round, ms: until the pictures are in memory, and without that copy if a renderer can tell.
    host: f64,
    device_only: Option<f64>,
    /// Pictures of both eyes of each state.
    pictures: Rc<Vec<u8>>,
}

/// Prints the times of both eyes of given numbers of environments: our renderers on a GPU and on the CPU, MuJoCo's on a GPU, and MuJoCo
/// Warp's if the variable `MJWARP_PYTHON` names a Python that has it.
///
/// # Errors
/// A missing graphics adapter; a Python that is missing or fails; a state that cannot be drawn.
pub fn print(environments: &[usize]) -> Result<(), String> {
    let egl = others::rows(&python::find()?, "egl", environments)?;
    let warp = match std::env::var_os("MJWARP_PYTHON").map(PathBuf::from) {
        None => Vec::new(),
        Some(python) => others::rows(&python, "mjwarp", environments)?,
    };
    let mut ours = Vec::new();
    for scene in Scene::BABYBENCH {
        ours.extend(ours::rows(scene, environments)?);
    }
    let rows: Vec<Row> = ours.into_iter().chain(egl).chain(warp).collect();
    println!(
        "Both eyes of many environments, 64 x 64 each: pictures a second, from the median of {ROUNDS} rounds by the clock, until all \
         are in the host's memory; in parentheses without that copy. Environment k has state k modulo 24 of \
         `conformance/data/render_*.npz`. {}.\n",
        devices(&rows)
    );
    print_rates(&rows, environments);
    println!(
        "\nMean absolute difference of the eyes' pictures of those states, of 255: from MuJoCo's renderer on this device, and from \
         the same by OSMesa.\n"
    );
    print_differences(&rows)
}

/// Names the renderers, in the order of the table.
fn renderers(rows: &[Row]) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for row in rows {
        if !names.contains(&row.renderer.as_str()) {
            names.push(&row.renderer);
        }
    }
    names
}

fn print_rates(rows: &[Row], environments: &[usize]) {
    let renderers = renderers(rows);
    println!("| scene | environments | {} |", renderers.join(" | "));
    println!("|---|--:|{}", "--:|".repeat(renderers.len()));
    for scene in Scene::BABYBENCH.iter().map(ToString::to_string) {
        for &n in environments {
            let cell = |renderer: &&str| {
                let here = |r: &&Row| (&r.scene, r.environments, r.renderer.as_str()) == (&scene, n, *renderer);
                let rate = |ms: f64| format!("{:.0}", 2e3 * n as f64 / ms);
                rows.iter()
                    .find(here)
                    .map_or(String::new(), |row| match row.device_only {
                        None => rate(row.host),
                        Some(ms) => format!("{} ({})", rate(row.host), rate(ms)),
                    })
            };
            let cells: Vec<String> = renderers.iter().map(cell).collect();
            println!("| {scene} | {n} | {} |", cells.join(" | "));
        }
    }
}

fn print_differences(rows: &[Row]) -> Result<(), String> {
    println!("| scene | renderer | from MuJoCo on this device | from MuJoCo with OSMesa |");
    println!("|---|---|--:|--:|");
    for scene in Scene::BABYBENCH.iter().map(ToString::to_string) {
        let osmesa = ours::osmesa(&scene)?;
        let of = |renderer: &str| rows.iter().find(|r| r.scene == scene && r.renderer == renderer);
        let here = of(others::EGL).ok_or("gpu_eyes.py gave no pictures by EGL")?;
        // rounds ahead and more threads give the same pictures
        let mut last: Option<&Rc<Vec<u8>>> = None;
        for row in renderers(rows).into_iter().filter_map(of) {
            if last
                .replace(&row.pictures)
                .is_some_and(|last| Rc::ptr_eq(last, &row.pictures))
            {
                continue;
            }
            println!(
                "| {scene} | {} | {:.3} | {:.3} |",
                row.renderer.trim_end_matches(", one thread"),
                apart(&row.pictures, &here.pictures),
                apart(&row.pictures, &osmesa)
            );
        }
    }
    Ok(())
}

/// Names each device once, after a renderer that runs on it.
fn devices(rows: &[Row]) -> String {
    let mut named: Vec<(&str, String)> = Vec::new();
    for row in rows {
        if named.iter().all(|(device, _)| *device != row.device) {
            named.push((&row.device, format!("{}: {}", row.renderer, row.device)));
        }
    }
    let named: Vec<String> = named.into_iter().map(|(_, name)| name).collect();
    named.join("; ")
}

/// Returns the mean difference of pictures, of 255.
fn apart(ours: &[u8], theirs: &[u8]) -> f64 {
    let mut difference = Difference::default();
    for (ours, theirs) in ours.chunks_exact(PICTURE).zip(theirs.chunks_exact(PICTURE)) {
        difference.add(ours, theirs, SIZE);
    }
    difference.mean()
}
