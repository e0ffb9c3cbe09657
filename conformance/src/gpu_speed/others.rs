//! The measurements of `scripts/gpu_eyes.py`.

use std::collections::BTreeMap;
use std::path::Path;
use std::rc::Rc;

use babybench::formats::npz::Npz;
use serde_json::Value;

use super::Row;
use crate::python;

/// The script's name for MuJoCo's own renderer.
pub const EGL: &str = "MuJoCo, EGL";

/// Measures another renderer.
pub fn rows(python: &Path, renderer: &str, environments: &[usize]) -> Result<Vec<Row>, String> {
    let script = python::script("gpu_eyes.py");
    let folder = tempfile::tempdir().map_err(|e| e.to_string())?;
    let file = folder.path().join("pictures.npz");
    let environments: Vec<String> = environments.iter().map(ToString::to_string).collect();
    let output = python::command(python)
        .env(
            "MUJOCO_GL",
            std::env::var_os("MUJOCO_GL").unwrap_or_else(|| "egl".into()),
        )
        .arg(&script)
        .args(["--renderer", renderer, "--environments", &environments.join(",")])
        .arg("--pictures")
        .arg(&file)
        .output()
        .map_err(|e| format!("cannot run {}: {e}", python.display()))?;
    if !output.status.success() {
        return Err(format!(
            "{} --renderer {renderer} failed:\n{}",
            script.display(),
            String::from_utf8_lossy(&output.stderr)
        ));
    }
    let pictures = Npz::open(&file).map_err(|e| e.to_string())?;
    let mut known = BTreeMap::new();
    // MuJoCo Warp prints what it compiles
    String::from_utf8_lossy(&output.stdout)
        .lines()
        .filter(|line| line.starts_with('{'))
        .map(|line| {
            let json = serde_json::from_str(line).map_err(|e| e.to_string());
            json.and_then(|json| row(&json, &pictures, &mut known))
                .map_err(|e| format!("unexpected line of {}: {e}: {line}", script.display()))
        })
        .collect()
}

fn row(json: &Value, pictures: &Npz, known: &mut BTreeMap<String, Rc<Vec<u8>>>) -> Result<Row, String> {
    let number = |key: &str| json[key].as_f64().ok_or_else(|| format!("no {key}"));
    let text = |key: &str| {
        json[key]
            .as_str()
            .map(str::to_string)
            .ok_or_else(|| format!("no {key}"))
    };
    let (scene, renderer) = (text("scene")?, text("renderer")?);
    let name = format!("{scene}: {renderer}");
    let pictures = match known.get(&name) {
        Some(pictures) => pictures.clone(),
        None => {
            let read = pictures.get_u8(&name).map_err(|e| e.to_string())?;
            known.entry(name).or_insert(Rc::new(read.data)).clone()
        }
    };
    Ok(Row {
        scene,
        renderer,
        device: text("device")?,
        environments: number("environments")? as usize,
        host: number("host")?,
        device_only: json["device_only"].as_f64(),
        pictures,
    })
}
