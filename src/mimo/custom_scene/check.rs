//! Checks of the document of a custom scene, before it is compiled.

use super::{CustomScene, CustomSceneError, DocumentSource, FILES, FOLDER};
use crate::assets::AssetSource;
use crate::limits::Limits;
use crate::mimo::ROOT;
use crate::mimo::error::SceneError;
use crate::mimo::scene::SceneSource;
use crate::mjcf_loader::{Node, Tree};

/// Settings of `<compiler>` that would read MIMo's own documents in another way, each with its only value.
const COMPILER: [(&str, &str, &str); 3] = [
    ("angle", "degree", "write degrees"),
    ("eulerseq", "xyz", "write angles about x, y and z, or use quat"),
    (
        "texturedir",
        "",
        "write the folder in front of the name of each texture",
    ),
];

/// The include of a document with a second infant.
const SECOND: &str = "other_mimo.xml";

/// The time step of all scenes, s.
const TIMESTEP: f64 = 0.005;

impl<A: AssetSource> CustomScene<A> {
    /// Checks that the document has a complete MIMo, at his place, and no setting that would change him.
    pub fn check(&self, source: &SceneSource<'_>) -> Result<(), SceneError> {
        let read = Tree::read(source.document, source.path, source.assets, &Limits::default());
        let (tree, _) = read.map_err(|e| self.localized_load(e))?;
        let whole = matches!(self.own, DocumentSource::Added(_));
        for (file, place, what) in FILES {
            // a scene of the library has him
            if !whole && !tree.files().contains(&format!("{FOLDER}{file}")) {
                let path = self.path.clone();
                return Err(CustomSceneError::Lacks {
                    path,
                    file,
                    place,
                    what,
                }
                .into());
            }
        }
        if self.second && !tree.files().contains(&format!("{FOLDER}{SECOND}")) {
            return Err(CustomSceneError::Lacks {
                path: self.path.clone(),
                file: SECOND,
                place: "in <body name=\"other_location\">",
                what: "the second infant, whom `learner` and `other_age` are about",
            }
            .into());
        }
        self.check_place(&tree)?;
        let own = |at: &usize| {
            let file = tree.file(*at);
            file != source.path && file.strip_prefix(FOLDER).is_some_and(|name| !self.library(name))
        };
        for at in (0..tree.nodes.len()).filter(own) {
            if let Some(reason) = fault(&tree, at) {
                return Err(self.at(&tree, at, reason).into());
            }
        }
        Ok(())
    }

    /// Checks that MIMo is attached to the body that defines his place.
    fn check_place(&self, tree: &Tree) -> Result<(), CustomSceneError> {
        let hip = |at: &usize| tree.nodes[*at].name == "body" && tree.nodes[*at].attribute("name") == Some(ROOT);
        let around = |node: &Node| node.children.iter().any(hip);
        let Some(at) = tree.nodes.iter().position(around) else {
            return Ok(()); // the assets have a MIMo of their own
        };
        let node = &tree.nodes[at];
        let place = self.place;
        if node.name == "body" && node.attribute("name") == Some(place) {
            return Ok(());
        }
        let reason = format!(
            "MIMo is included in <{}>; include the learner in a body of its own, <body name=\"{place}\" pos=\"0 0 0.1\" \
             euler=\"0 -90 0\">, with <freejoint name=\"{place}\"/> if he is free to move",
            node.name
        );
        Err(self.at(tree, at, reason))
    }

    fn at(&self, tree: &Tree, at: usize, reason: String) -> CustomSceneError {
        let mut place = tree.place(at);
        self.locate(&mut place);
        CustomSceneError::At {
            place: Box::new(place),
            reason,
        }
    }
}

/// Describes a fault of an added element.
fn fault(tree: &Tree, at: usize) -> Option<String> {
    let node = &tree.nodes[at];
    // settings of a model whose bodies are attached hold for it alone
    let model = tree.model_of(at) > 0;
    match node.name.as_str() {
        "compiler" | "option" if model => None,
        "compiler" => COMPILER.iter().find_map(|(name, only, remedy)| {
            let text = node.attribute(name).filter(|text| text != only)?;
            Some(format!(
                "{name}=\"{text}\" would be a setting of MIMo's documents, too; {remedy}"
            ))
        }),
        "option" => {
            let text = node.attribute("timestep")?;
            let same = text.trim().parse() == Ok(TIMESTEP);
            (!same).then(|| format!("timestep=\"{text}\": physics steps have {TIMESTEP} s; leave timestep out"))
        }
        "texture" | "mesh" | "hfield" | "skin" | "model" => {
            let named = node.attributes.iter().filter(|(name, _)| name.starts_with("file"));
            let mut outside = named.filter(|(_, path)| path.split('/').next() == Some(".."));
            let (name, path) = outside.next()?;
            Some(format!(
                "{name}=\"{path}\" lies outside the document's folder; move it there"
            ))
        }
        _ => None,
    }
}
