//! Documents that a program edits: the tree behind `MjSpec`.

use std::collections::HashMap;
use std::path::PathBuf;

use babybench::mjcf_loader::edit::{Document, EditError, ElementId, Kind};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::errors::{IntoException, detached};
use crate::given_files::GivenFiles;

impl IntoException for EditError {
    fn into_exception(self) -> PyErr {
        PyValueError::new_err(self.to_string())
    }
}

/// A document as a tree of elements, which are numbers here.
#[pyclass(module = "babybench_core._native")]
#[derive(Clone)]
pub struct MjcfDocument {
    document: Document,
    numbers: HashMap<usize, ElementId>,
}

fn wrong(error: EditError) -> PyErr {
    error.into_exception()
}

fn kind_of(name: &str) -> PyResult<Kind> {
    Kind::of(name).ok_or_else(|| PyValueError::new_err(format!("{name:?} is not a kind of element")))
}

impl MjcfDocument {
    fn made(document: Document) -> Self {
        let mut made = Self {
            document,
            numbers: HashMap::new(),
        };
        made.number(made.document.root());
        made
    }

    /// Returns the number of an element in the document.
    fn number(&mut self, id: ElementId) -> usize {
        self.numbers.insert(id.index(), id);
        id.index()
    }

    fn numbered(&mut self, ids: Vec<ElementId>) -> Vec<usize> {
        ids.into_iter().map(|id| self.number(id)).collect()
    }

    fn id(&self, number: usize) -> PyResult<ElementId> {
        let what = || PyValueError::new_err(format!("element {number} is not in this document"));
        self.numbers.get(&number).copied().ok_or_else(what)
    }
}

#[pymethods]
impl MjcfDocument {
    #[new]
    fn new() -> Self {
        Self::made(Document::new())
    }

    /// Reads a text, with files that replace those in and around a folder.
    #[staticmethod]
    fn from_text(
        py: Python<'_>,
        text: &str,
        path: &str,
        files: HashMap<String, Vec<u8>>,
        folder: PathBuf,
    ) -> PyResult<Self> {
        let assets = GivenFiles::new(files, folder)?;
        detached(py, || Document::read_str(text, path, &assets)).map(Self::made)
    }

    /// Reads a file of a folder.
    #[staticmethod]
    fn from_file(py: Python<'_>, path: &str, files: HashMap<String, Vec<u8>>, folder: PathBuf) -> PyResult<Self> {
        let assets = GivenFiles::new(files, folder)?;
        detached(py, || Document::read(&assets, path)).map(Self::made)
    }

    fn copy(&self) -> Self {
        self.clone()
    }

    fn root(&mut self) -> usize {
        self.number(self.document.root())
    }

    fn world(&mut self) -> usize {
        self.number(self.document.world())
    }

    /// Returns the section with a name, or creates it.
    fn section(&mut self, name: &str) -> PyResult<usize> {
        let id = self.document.section(name).map_err(wrong)?;
        Ok(self.number(id))
    }

    fn add(&mut self, parent: usize, element: &str) -> PyResult<usize> {
        let id = self.document.add(self.id(parent)?, element).map_err(wrong)?;
        Ok(self.number(id))
    }

    fn insert(&mut self, parent: usize, element: &str, index: usize) -> PyResult<usize> {
        let id = self.document.insert(self.id(parent)?, element, index).map_err(wrong)?;
        Ok(self.number(id))
    }

    /// Removes an element, and also the elements that refer to it unless `alone` is set.
    fn remove(&mut self, number: usize, alone: bool) -> PyResult<()> {
        let id = self.id(number)?;
        if alone {
            self.document.remove_alone(id).map_err(wrong)
        } else {
            self.document.remove(id).map(drop).map_err(wrong)
        }
    }

    fn contains(&self, number: usize) -> bool {
        self.numbers.get(&number).is_some_and(|id| self.document.contains(*id))
    }

    fn set(&mut self, number: usize, name: &str, value: &str) -> PyResult<()> {
        self.document.set(self.id(number)?, name, value).map_err(wrong)
    }

    fn unset(&mut self, number: usize, name: &str) -> PyResult<()> {
        self.document.unset(self.id(number)?, name).map_err(wrong)
    }

    /// Returns the text of an attribute as given in the document.
    fn get(&self, number: usize, name: &str) -> PyResult<Option<String>> {
        let text = self.document.attribute(self.id(number)?, name).map_err(wrong)?;
        Ok(text.map(str::to_owned))
    }

    /// Returns the text of an attribute with default classes applied.
    fn value(&self, number: usize, name: &str) -> PyResult<String> {
        self.document.value(self.id(number)?, name).map_err(wrong)
    }

    fn attributes(&self, number: usize) -> PyResult<Vec<(String, String)>> {
        let given = self.document.attributes(self.id(number)?).map_err(wrong)?;
        Ok(given.map(|(name, text)| (name.to_owned(), text.to_owned())).collect())
    }

    fn parent(&mut self, number: usize) -> PyResult<Option<usize>> {
        let parent = self.document.parent(self.id(number)?).map_err(wrong)?;
        Ok(parent.map(|id| self.number(id)))
    }

    fn children(&mut self, number: usize) -> PyResult<Vec<usize>> {
        let children = self.document.children(self.id(number)?).map_err(wrong)?;
        Ok(self.numbered(children))
    }

    fn element(&self, number: usize) -> PyResult<&'static str> {
        self.document.element(self.id(number)?).map_err(wrong)
    }

    fn kind(&self, number: usize) -> PyResult<Option<&'static str>> {
        let kind = self.document.kind(self.id(number)?).map_err(wrong)?;
        Ok(kind.map(Kind::name))
    }

    fn all(&mut self, kind: &str) -> PyResult<Vec<usize>> {
        let found = self.document.all(kind_of(kind)?);
        Ok(self.numbered(found))
    }

    fn find(&mut self, kind: &str, name: &str) -> PyResult<Option<usize>> {
        let found = self.document.find(kind_of(kind)?, name);
        Ok(found.map(|id| self.number(id)))
    }

    fn class_of(&self, number: usize) -> PyResult<String> {
        self.document.class_of(self.id(number)?).map_err(wrong)
    }

    fn attach(&mut self, parent: usize, other: &Self, body: usize, prefix: &str, suffix: &str) -> PyResult<usize> {
        let (parent, body) = (self.id(parent)?, other.id(body)?);
        let new = self
            .document
            .attach(parent, &other.document, body, prefix, suffix)
            .map_err(wrong)?;
        Ok(self.number(new))
    }

    fn move_to(&mut self, number: usize, parent: usize) -> PyResult<()> {
        let (id, parent) = (self.id(number)?, self.id(parent)?);
        self.document.move_to(id, parent).map_err(wrong)
    }

    fn generalize(&mut self, number: usize) -> PyResult<()> {
        self.document.generalize(self.id(number)?).map_err(wrong)
    }

    fn write(&self) -> String {
        self.document.write()
    }
}
