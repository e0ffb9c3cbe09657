//! The faces that are not in the module: their pictures would be a tenth of the download of a first visit, and are rarely shown.

use std::borrow::Cow;
use std::cell::RefCell;

use babybench::assets::{AssetError, AssetSource, MemoryAssets};
use babybench::config::FacialExpression;
use wasm_bindgen::prelude::*;

use crate::js;

thread_local! {
    /// The pictures that were added.
    static BROUGHT: RefCell<MemoryAssets> = RefCell::default();
}

fn path_of(face: FacialExpression) -> String {
    format!("tex/face_{face}.png")
}

/// Keeps the picture of a face, a PNG file, for every scene that is drawn from now on.
#[wasm_bindgen(js_name = bringFace)]
pub fn bring_face(name: &str, picture: Vec<u8>) -> Result<(), JsValue> {
    let face = FacialExpression::from_name(name).ok_or_else(|| js::error("there is no such face"))?;
    let kept = BROUGHT.with_borrow_mut(|brought| brought.insert(&path_of(face), picture));
    kept.map_err(js::error)
}

/// The pictures of faces as a source. Requesting a picture that was not added yet is an error that says how to add it.
pub struct Faces;

impl AssetSource for Faces {
    fn read(&self, path: &str) -> Result<Cow<'_, [u8]>, AssetError> {
        let brought = BROUGHT.with_borrow(|brought| brought.read(path).map(Cow::into_owned));
        let away = FacialExpression::ALL.iter().find(|face| path_of(**face) == path);
        match (brought, away) {
            (Err(AssetError::NotFound(path)), Some(face)) if *face != FacialExpression::Default => {
                Err(AssetError::Io {
                    path,
                    message: format!("this face is fetched when it is wanted: `await loadFace(\"{face}\")` first"),
                })
            }
            (brought, _) => brought.map(Cow::Owned),
        }
    }
}
