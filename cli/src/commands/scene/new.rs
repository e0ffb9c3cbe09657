//! `babybench scene new`

use std::error::Error;
use std::fs::{File, create_dir_all};
use std::io::Write as _;
use std::path::PathBuf;

use clap::Args;

use crate::arguments::word;
use crate::print::say;

/// Names and texts of the files.
const FILES: [(&str, &str); 2] = [
    ("room.xml", include_str!("room.xml")),
    ("room.yml", include_str!("room.yml")),
];

/// Arguments of `scene new`.
#[derive(Args)]
pub struct New {
    /// Folder to write to, which is created if necessary
    #[arg(value_name = "DIR")]
    dir: PathBuf,
}

impl New {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        let paths = FILES.map(|(name, _)| self.dir.join(name));
        // before the first file is written
        if let Some(path) = paths.iter().find(|path| path.symlink_metadata().is_ok()) {
            return Err(format!("{}: this file already exists; choose another folder", path.display()).into());
        }
        let failed = |path: &PathBuf, e: std::io::Error| format!("{}: {e}", path.display());
        create_dir_all(&self.dir).map_err(|e| failed(&self.dir, e))?;
        for (path, (_, text)) in paths.iter().zip(FILES) {
            let written = File::create_new(path).and_then(|mut file| file.write_all(text.as_bytes()));
            written.map_err(|e| failed(path, e))?;
            say!("{}", path.display())?;
        }
        let config = word(paths[1].display());
        say!("next: babybench scene check {config}")?;
        say!("      babybench render --config {config} --camera corner --out room.png")?;
        say!("      babybench run --config {config}")?;
        Ok(())
    }
}
