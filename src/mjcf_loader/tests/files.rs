//! Documents of several files: includes, layers of sources, folders, textures.

use super::*;

#[test]
fn textures_are_recipes_with_normalised_paths() {
    let texture = |attributes: &str| {
        let text = format!("<mujoco><asset><texture {attributes}/></asset></mujoco>");
        let assets = source(&[("tex/a.png", ""), ("kit/b.png", "")]);
        load_str(&text, "kit/m.xml", &assets)
            .map(|spec| spec.arrays.textures[0].clone())
            .map_err(|e| e.kind.to_string())
    };
    let found = texture("name='t' fileup='../tex/a.png' filedown='b.png'").unwrap();
    assert_eq!(found.cube_files[2].as_deref(), Some("tex/a.png"));
    assert_eq!(found.cube_files[3].as_deref(), Some("kit/b.png"));
    assert_eq!(texture("type='2d' file='./b.png'").unwrap().name, "b");
    let grid = texture("file='b.png' gridsize='2 3' gridlayout='.ULFRB'").unwrap();
    assert_eq!(grid.gridsize, [2, 3]);
    assert_eq!(grid.gridlayout, [None, Some(2), Some(1), Some(4), Some(0), Some(5)]);
    let error = |attributes| texture(attributes).unwrap_err();
    assert_eq!(error("name='t' file='a.png'"), "file \"kit/a.png\" does not exist");
    assert_eq!(
        error("file='b.png' gridsize='2 3' gridlayout='.U'"),
        "gridlayout must have a letter for each square of gridsize, row by row"
    );
    assert_eq!(
        error("file='b.png' gridsize='2 7'"),
        "gridsize must be two whole numbers, of no more than 12 squares in all"
    );
    assert_eq!(
        error("file='b.png' gridsize='1 2' gridlayout='.Q'"),
        "gridlayout may have the letters R, L, U, D, F and B, and dots"
    );
    let outside = "path \"../../a.png\" is not a relative path inside the asset source";
    assert_eq!(error("name='t' file='../../a.png'"), outside);
    assert_eq!(error("name='t'"), "the texture has neither a builtin nor a file");
    assert_eq!(
        error("name='t' builtin='flat'"),
        "a builtin texture needs a width, and if it is flat a height"
    );
    assert_eq!(
        error("type='2d' builtin='flat' width='1' height='1'"),
        "attribute \"name\" is required"
    );
    assert_eq!(error("name='t' width='20000'"), "width: 20000 must be from 0 to 16384");
}

#[test]
fn includes_splice_and_are_bounded() {
    assert_eq!(outcome("<mujoco><include file='other.xml'/></mujoco>"), "");
    check(
        "<include file='m.xml'/>",
        "mujoco/include: file \"m.xml\" is already included",
    );
    check(
        "<include file='other.xml'/><include file='./other.xml'/>",
        "mujoco/include: file \"other.xml\" is already included",
    );
    check(
        "<include file='none.xml'/>",
        "mujoco/include: file \"none.xml\" does not exist",
    );
    check("<include/>", "mujoco/include: attribute \"file\" is required");
    // as in MuJoCo, which looks at no other attribute
    assert_eq!(outcome("<mujoco><include file='other.xml' a='b'/></mujoco>"), "");
    check(
        "<include file='other.xml'><geom/></include>",
        "mujoco/include/geom: unknown element \"geom\"",
    );
    check(
        "<include file='other.xml'><!-- a --></include>",
        "mujoco/include: an include is empty: put comments before it",
    );
    for path in ["/etc/passwd", "../m.xml", "a/../../m.xml", "c:/x", "a\\b", ""] {
        let message = format!("mujoco/include: path \"{path}\" is not a relative path inside the asset source");
        check(&format!("<include file='{path}'/>"), &message);
    }
    let chain: Vec<(String, String)> = (0..20)
        .map(|k| (format!("{k}.xml"), format!("<a><include file='{}.xml'/></a>", k + 1)))
        .collect();
    let files: Vec<(&str, &str)> = chain
        .iter()
        .map(|(path, text)| (path.as_str(), text.as_str()))
        .collect();
    let error = load_str("<mujoco><include file='0.xml'/></mujoco>", "m.xml", &source(&files)).unwrap_err();
    assert_eq!(error.to_string(), "15.xml:1:4: a/include: more than 16 nested includes");
    let broken = source(&[("a.xml", "<a model='x' b='c'/>"), ("b.xml", "<a>")]);
    let kept = source(&[("a.xml", "<a model='x' b='c'><option timestep='.1'/></a>")]);
    let included = load_str("<mujoco><include file='a.xml'/></mujoco>", "m.xml", &kept).expect("loads");
    assert_eq!(included.arrays.opt.timestep, 0.1);
    let error = |file: &str| {
        let text = format!("<mujoco><include file='{file}'/></mujoco>");
        load_str(&text, "m.xml", &broken).unwrap_err().to_string()
    };
    let empty = "a.xml:1:1: a: the file has no elements: give it some, or remove what includes it";
    assert_eq!(error("a.xml"), empty);
    assert_eq!(
        error("b.xml"),
        "b.xml:1:4: a: malformed XML: the file ends inside an element"
    );
}

/// Returns a height field of `rows` rows and two columns.
fn heights(rows: u32) -> Vec<u8> {
    let sizes = [rows, 2].map(u32::to_le_bytes).concat();
    [sizes, vec![0; 8 * rows as usize]].concat()
}

/// What MuJoCo 3.3.0 finds, for each of the files that are there.
#[test]
fn included_files_find_theirs_beside_themselves() {
    let include = "<mujoco><compiler meshdir='m' texturedir='t' FOLDER/><include file='s/a.xml'/></mujoco>";
    let asset = "<a><asset><texture type='2d' file='b.png'/><hfield file='b.hf' size='1 1 1 1'/></asset></a>";
    let found = |folder: &str, images: &[&str], fields: &[&str]| {
        let mut files = source(&[("k/s/a.xml", asset)]);
        for place in images {
            files.insert(&format!("k/{place}b.png"), "").unwrap();
        }
        for (place, rows) in fields.iter().zip(2..) {
            files.insert(&format!("k/{place}b.hf"), heights(rows)).unwrap();
        }
        let spec = load_str(&include.replace("FOLDER", folder), "k/m.xml", &files);
        spec.map(|spec| {
            let image = spec.arrays.textures[0].file.clone().unwrap();
            (image, fields[spec.arrays.hfields[0].nrow - 2].to_owned())
        })
        .map_err(|e| e.to_string())
    };
    let pair = |image: &str, field: &str| Ok((image.to_owned(), field.to_owned()));
    assert_eq!(found("", &["s/"], &["s/"]), pair("k/s/b.png", "s/"));
    assert_eq!(found("", &["", "t/", "s/"], &["m/", "s/"]), pair("k/t/b.png", "s/"));
    assert_eq!(found("", &["", "s/"], &["", "m/", "s/"]), pair("k/s/b.png", "m/"));
    assert_eq!(
        found("assetdir='d'", &["t/"], &["d/", "m/", "s/"]),
        pair("k/t/b.png", "m/")
    );
    assert_eq!(
        found("assetdir='d'", &["t/"], &["", "m/", "s/"]),
        pair("k/t/b.png", "s/")
    );
    assert_eq!(
        found("strippath='true'", &["t/", "s/"], &["m/", "s/"]),
        pair("k/t/b.png", "m/")
    );
    let missing = found("", &[""], &["m/"]).unwrap_err();
    assert_eq!(
        missing,
        "k/s/a.xml:1:11: a/asset/texture: file \"k/t/b.png\" does not exist"
    );
}

#[test]
fn nested_includes_and_models_are_beside_the_included_file() {
    let body = |name: &str| format!("<mujoco><worldbody><body name='{name}'/></worldbody></mujoco>");
    let names = |files: &[(&str, &str)]| {
        let text = "<mujoco><include file='s/a.xml'/></mujoco>";
        let spec = load_str(text, "k/m.xml", &source(files)).map_err(|e| e.to_string())?;
        Ok::<_, String>(spec.arrays.body_name[1].clone())
    };
    let nested = ("k/s/a.xml", "<a><include file='b.xml'/></a>");
    let (main, near) = (body("main"), body("near"));
    assert_eq!(
        names(&[nested, ("k/b.xml", &main), ("k/s/b.xml", &near)]).unwrap(),
        "main"
    );
    assert_eq!(names(&[nested, ("k/s/b.xml", &near)]).unwrap(), "near");
    assert_eq!(
        names(&[nested]).unwrap_err(),
        "k/s/a.xml:1:4: a/include: file \"k/b.xml\" does not exist"
    );
    let attach = "<a><asset><model name='x' file='b.xml'/></asset><worldbody><attach model='x' body='near' prefix='its_'/></worldbody></a>";
    let model = ("k/s/a.xml", attach);
    assert_eq!(
        names(&[model, ("k/b.xml", &main), ("k/s/b.xml", &near)]).unwrap(),
        "its_near"
    );
    assert_eq!(
        names(&[model, ("k/b.xml", &main)]).unwrap_err(),
        "k/s/a.xml:1:11: a/asset/model: file \"k/s/b.xml\" does not exist"
    );
}

#[test]
fn layers_and_embedded_files_are_found() {
    static FILES: &[(&str, &[u8])] = &[
        ("kit/a.xml", b"<mujoco model='embedded'/>"),
        ("b.xml", b"\xff"),
        ("out.png", b""),
    ];
    let below = EmbeddedAssets(FILES);
    let above = source(&[("kit/c.xml", "<mujoco model='above'/>")]);
    let both = Overlay::new(below).with(above);
    assert_eq!(load(&both, "kit/./a.xml").unwrap().name(), "embedded");
    assert_eq!(load(&both, "x/../kit/c.xml").unwrap().name(), "above");
    assert_eq!(
        load(&both, "b.xml").unwrap_err().to_string(),
        "b.xml: not UTF-8 text, nor does it begin with <?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>"
    );
    assert_eq!(
        load(&both, "d.xml").unwrap_err().to_string(),
        "d.xml: file \"d.xml\" does not exist"
    );
    assert!(both.contains("b.xml") && !both.contains("d.xml"));
    assert!(both.contains("out.png"));
    let left_out = both.read("out.png").unwrap_err().to_string();
    assert!(left_out.contains("this build leaves it out"), "{left_out}");
}

#[cfg(unix)]
#[test]
fn directories_do_not_leak() {
    let base = std::env::temp_dir().join(format!("babybench-assets-{}", std::process::id()));
    let root = base.join("root");
    std::fs::create_dir_all(root.join("kit")).unwrap();
    std::fs::write(base.join("secret.xml"), "<mujoco/>").unwrap();
    std::fs::write(root.join("kit/a.xml"), "<mujoco/>").unwrap();
    std::os::unix::fs::symlink(base.join("secret.xml"), root.join("kit/link.xml")).unwrap();
    std::os::unix::fs::symlink(root.join("kit/a.xml"), root.join("inner.xml")).unwrap();
    let assets = DirAssets::new(&root).unwrap();
    let small = DirAssets::with_limits(
        &root,
        &Limits {
            asset_bytes: 8,
            ..Limits::default()
        },
    )
    .unwrap();
    let too_large = small.read("kit/a.xml").unwrap_err().to_string();
    let outcomes = [
        "kit/a.xml",
        "inner.xml",
        "kit/link.xml",
        "../secret.xml",
        "kit",
        "none.xml",
        "kit/a.xml/b",
    ]
    .map(|path| assets.read(path).map(|bytes| bytes.len()).map_err(|e| e.to_string()));
    std::fs::remove_dir_all(&base).unwrap();
    assert_eq!(too_large, "file \"kit/a.xml\" is larger than 8 bytes");
    assert_eq!(outcomes[..2], [Ok(9), Ok(9)]);
    for (outcome, word) in outcomes[2..].iter().zip([
        "leads out of the folder",
        "inside",
        "a folder, not a regular file",
        "exist",
        "exist",
    ]) {
        assert!(outcome.as_ref().unwrap_err().contains(word), "{outcome:?}");
    }
}
