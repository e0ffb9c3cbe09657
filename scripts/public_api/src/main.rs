//! Prints the public interface of a crate, a line for each item: `public-api-listing FILE`, the JSON that rustdoc writes. Implementations
//! that are derived, automatic or blanket are left out.

use std::error::Error;
use std::io::Write;

use public_api::Builder;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("name the file that rustdoc has written")?;
    let interface = Builder::from_rustdoc_json(path)
        .sorted(true)
        .omit_blanket_impls(true)
        .omit_auto_trait_impls(true)
        .omit_auto_derived_impls(true)
        .build()?;
    let mut out = std::io::stdout().lock();
    for item in interface.items() {
        writeln!(out, "{item}")?;
    }
    Ok(())
}
