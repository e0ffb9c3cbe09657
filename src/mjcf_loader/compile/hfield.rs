//! Compiles height fields.

use super::asset_name::asset_name;
use super::context::Context;
use crate::assets::AssetSource;
use crate::document::TypedDocument;
use crate::error::{ErrorKind, LoadError};
use crate::formats::heights::{HeightFormat, Heights};
use crate::limits::Limits;
use crate::mesh::HField;
use crate::model;

/// Compiles the height fields, whose files are looked up in `source`. Their heights together count towards the limit on mesh elements.
pub(super) fn compile_hfields(
    context: &Context,
    document: &TypedDocument,
    source: &dyn AssetSource,
) -> Result<Vec<model::HField>, LoadError> {
    // all height fields together: each alone could be within the limits
    let mut limits = context.tree.limits.clone();
    let compile = |hfield| {
        let compiled = compile_hfield(context, hfield, source, &limits)?;
        limits.mesh_elements = limits.mesh_elements.saturating_sub(compiled.data.len());
        Ok(compiled)
    };
    document.hfields.iter().map(compile).collect()
}

fn compile_hfield(
    context: &Context,
    hfield: &HField,
    source: &dyn AssetSource,
    limits: &Limits,
) -> Result<model::HField, LoadError> {
    let invalid = |message| Err(context.invalid(hfield.at, message));
    if hfield.size.iter().any(|&v| v <= 0.0) {
        return invalid("the four numbers of size must be positive");
    }
    let Heights { nrow, ncol, mut data } = match &hfield.file {
        Some(file) => from_file(context, hfield, file, source, limits)?,
        None => from_numbers(hfield, limits)
            .map_err(|message| context.error(hfield.at, ErrorKind::Mesh { file: None, message }))?,
    };
    if nrow < 2 || ncol < 2 {
        return invalid("a height field needs 2 rows and 2 columns at least");
    }
    // MuJoCo scales heights to 0..1, and starts its search at these bounds
    let (mut low, mut high) = (1e10_f32, -1e10_f32);
    for &v in &data {
        (low, high) = (low.min(v), high.max(v));
    }
    for v in &mut data {
        *v -= low;
        if high > low {
            *v /= high - low;
        }
    }
    // the difference of two finite numbers overflows
    if !data.iter().all(|v| v.is_finite()) {
        return invalid("the heights are too far from each other for single precision");
    }
    Ok(model::HField {
        name: asset_name(context.tree, hfield.at, &hfield.name, hfield.file.as_deref())?,
        size: hfield.size,
        nrow,
        ncol,
        data,
    })
}

/// Reads the heights in the document. Its first row has the greatest y.
fn from_numbers(hfield: &HField, limits: &Limits) -> Result<Heights, String> {
    let (nrow, ncol) = (hfield.nrow, hfield.ncol);
    let count = nrow.saturating_mul(ncol);
    Heights::check_count(count, limits)?;
    let data = if hfield.elevation.is_empty() {
        vec![0.0; count]
    } else if hfield.elevation.len() == count {
        // documents begin with the row at the top of the page, the model's arrays with the lowest y
        let rows = hfield.elevation.chunks(ncol.max(1)).rev();
        rows.flatten().map(|&v| v as f32).collect()
    } else {
        return Err("elevation must have nrow times ncol numbers".to_owned());
    };
    Ok(Heights { nrow, ncol, data })
}

fn from_file(
    context: &Context,
    hfield: &HField,
    file: &str,
    source: &dyn AssetSource,
    limits: &Limits,
) -> Result<Heights, LoadError> {
    let path = context.asset_path(hfield.at, file, context.mesh_dirs(hfield.at), source)?;
    let format = match &hfield.content_type {
        Some(content_type) => HeightFormat::of_content(content_type)
            .ok_or_else(|| context.invalid(hfield.at, "content_type must be image/png or image/vnd.mujoco.hfield"))?,
        None => HeightFormat::of_path(&path),
    };
    let bytes = source.read(&path).map_err(|e| context.error(hfield.at, e))?;
    Heights::read(&bytes, format, limits).map_err(|message| {
        context.error(
            hfield.at,
            ErrorKind::Mesh {
                file: Some(path),
                message,
            },
        )
    })
}
