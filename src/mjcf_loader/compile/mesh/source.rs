//! Vertices, faces and texture coordinates of a mesh, from its file and from its attributes.

use crate::assets::AssetSource;
use crate::compile::context::Context;
use crate::error::{ErrorKind, LoadError};
use crate::formats::mesh::{MeshFormat, Triangles};
use crate::limits::Limits;
use crate::mesh::Mesh;

/// Triangles as they were read.
pub(super) type Surface = Triangles;

/// Reads a mesh from its file, at `path` of `source`, and its attributes, and takes the number of its elements from `left`.
pub(super) fn read(
    context: &Context,
    mesh: &Mesh,
    path: Option<&str>,
    source: &dyn AssetSource,
    left: &mut usize,
) -> Result<Surface, LoadError> {
    let invalid = |message| context.invalid(mesh.at, message);
    let mut surface = match path {
        Some(path) => from_file(context, mesh, path, source, *left)?,
        None => Surface::default(),
    };
    if path.is_none()
        && mesh
            .content_type
            .as_ref()
            .is_some_and(|format| !is_content_type(format))
    {
        return Err(invalid(
            "content_type must be two words with a slash between, such as model/obj",
        ));
    }
    let of_obj = path.is_some_and(|path| format(mesh, path) == Some(MeshFormat::Obj));
    own(mesh, &mut surface).map_err(invalid)?;
    *left = left.checked_sub(surface.elements()).ok_or_else(|| {
        let limit = context.tree.limits.mesh_elements;
        context.error(
            mesh.at,
            ErrorKind::TooMuch {
                what: "vertices, normals, texture coordinates and faces of meshes",
                limit,
            },
        )
    })?;
    if surface.vert.len() < 4 {
        return Err(invalid("a mesh needs 4 vertices at least"));
    }
    surface.check().map_err(|error| {
        let message = error.to_string();
        context.error(
            mesh.at,
            ErrorKind::Mesh {
                file: path.map(str::to_owned),
                message,
            },
        )
    })?;
    let texcoords = surface.texcoord.len();
    if !of_obj && surface.facetexcoord.is_empty() && texcoords != 0 && texcoords != surface.vert.len() {
        return Err(invalid("there must be as many texture coordinates as vertices"));
    }
    Ok(surface)
}

/// Returns whether a format is written like a media type: a kind, a slash, a name.
fn is_content_type(text: &str) -> bool {
    text.split_once('/')
        .is_some_and(|(kind, name)| !kind.is_empty() && !name.is_empty())
}

/// Returns the format of a file.
fn format(mesh: &Mesh, path: &str) -> Option<MeshFormat> {
    match &mesh.content_type {
        Some(content_type) => MeshFormat::of_content(content_type),
        None => MeshFormat::of_path(path),
    }
}

fn from_file(
    context: &Context,
    mesh: &Mesh,
    path: &str,
    source: &dyn AssetSource,
    left: usize,
) -> Result<Surface, LoadError> {
    let format = format(mesh, path).ok_or_else(|| {
        context.invalid(
            mesh.at,
            "a mesh is in an OBJ, STL or MSH file; say by content_type which it is",
        )
    })?;
    let bytes = source.read(path).map_err(|e| context.error(mesh.at, e))?;
    let [x, y, z] = mesh.scale;
    let limits = Limits {
        mesh_elements: left,
        ..context.tree.limits.clone()
    };
    // as MuJoCo decides it
    let righthanded = x * y * z > 0.0;
    Triangles::read(&bytes, format, !righthanded, &limits).map_err(|error| {
        let (file, message) = (Some(path.to_owned()), error.to_string());
        context.error(mesh.at, ErrorKind::Mesh { file, message })
    })
}

/// Adds the data in the document itself. Data that the file also has are an error.
fn own(mesh: &Mesh, surface: &mut Surface) -> Result<(), &'static str> {
    fill(
        &mut surface.vert,
        rows(&mesh.vertex, "vertex must have three numbers for each vertex")?,
        "the file has vertices already",
    )?;
    fill(
        &mut surface.normal,
        rows(&mesh.normal, "normal must have three numbers for each normal")?,
        "the file has normals already",
    )?;
    fill(
        &mut surface.texcoord,
        rows(&mesh.texcoord, "texcoord must have two numbers for each vertex")?,
        "the file has texture coordinates already",
    )?;
    let faces: Vec<[u32; 3]> = indices(&mesh.face)?;
    fill(&mut surface.face, faces, "the file has faces already")
}

fn fill<T>(into: &mut Vec<T>, from: Vec<T>, twice: &'static str) -> Result<(), &'static str> {
    match (into.is_empty(), from.is_empty()) {
        (_, true) => {}
        (true, false) => *into = from,
        (false, false) => return Err(twice),
    }
    Ok(())
}

/// Returns numbers in rows of `N`, in single precision.
pub(crate) fn rows<const N: usize>(numbers: &[f64], wrong: &'static str) -> Result<Vec<[f32; N]>, &'static str> {
    let (rows, rest) = numbers.as_chunks::<N>();
    if rest.is_empty() {
        Ok(rows.iter().map(|row| row.map(|x| x as f32)).collect())
    } else {
        Err(wrong)
    }
}

/// Returns the corners of triangles.
pub(crate) fn indices(numbers: &[f64]) -> Result<Vec<[u32; 3]>, &'static str> {
    let (rows, rest) = numbers.as_chunks::<3>();
    let index = |x: &f64| x.fract() == 0.0 && (0.0..f64::from(u32::MAX)).contains(x);
    if !rest.is_empty() || !numbers.iter().all(index) {
        return Err("face must have three whole numbers from 0 for each triangle");
    }
    Ok(rows.iter().map(|row| row.map(|x| x as u32)).collect())
}
