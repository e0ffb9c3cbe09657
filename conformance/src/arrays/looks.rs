//! Arrays that only change pictures.

use babybench::Model;

use super::{Named, flat, groups, optional};

/// Returns the arrays that only change what is drawn.
pub fn looks(m: &Model) -> Named {
    [of_colours(m), of_lights(m), of_materials(m), of_views(m)].concat()
}

fn of_colours(m: &Model) -> Named {
    vec![
        ("geom_group", groups(&m.geom_group)),
        ("geom_rgba", flat(&m.geom_rgba)),
        ("geom_matid", optional(&m.geom_matid)),
        ("site_group", groups(&m.site_group)),
        ("site_rgba", flat(&m.site_rgba)),
        ("site_matid", optional(&m.site_matid)),
    ]
}

fn of_lights(m: &Model) -> Named {
    vec![
        ("light_bodyid", m.lights.iter().map(|l| l.bodyid as f64).collect()),
        (
            "light_mode",
            m.lights.iter().map(|l| f64::from(l.mode.code())).collect(),
        ),
        (
            "light_targetbodyid",
            optional(&m.lights.iter().map(|l| l.targetbodyid).collect::<Vec<_>>()),
        ),
        ("light_pos0", m.lights.iter().flat_map(|l| l.pos0).collect()),
        ("light_poscom0", m.lights.iter().flat_map(|l| l.poscom0).collect()),
        ("light_dir0", m.lights.iter().flat_map(|l| l.dir0).collect()),
        (
            "light_directional",
            m.lights.iter().map(|l| f64::from(u8::from(l.directional))).collect(),
        ),
        (
            "light_castshadow",
            m.lights.iter().map(|l| f64::from(u8::from(l.castshadow))).collect(),
        ),
        ("light_pos", m.lights.iter().flat_map(|l| l.pos).collect()),
        ("light_dir", m.lights.iter().flat_map(|l| l.dir).collect()),
        ("light_ambient", m.lights.iter().flat_map(|l| l.ambient).collect()),
        ("light_diffuse", m.lights.iter().flat_map(|l| l.diffuse).collect()),
        ("light_specular", m.lights.iter().flat_map(|l| l.specular).collect()),
        (
            "light_attenuation",
            m.lights.iter().flat_map(|l| l.attenuation).collect(),
        ),
        ("light_cutoff", m.lights.iter().map(|l| l.cutoff).collect()),
        ("light_exponent", m.lights.iter().map(|l| l.exponent).collect()),
    ]
}

fn of_materials(m: &Model) -> Named {
    vec![
        ("mat_rgba", m.materials.iter().flat_map(|x| x.rgba).collect()),
        ("mat_specular", m.materials.iter().map(|x| x.specular).collect()),
        ("mat_shininess", m.materials.iter().map(|x| x.shininess).collect()),
        ("mat_reflectance", m.materials.iter().map(|x| x.reflectance).collect()),
        ("mat_emission", m.materials.iter().map(|x| x.emission).collect()),
        ("mat_texrepeat", m.materials.iter().flat_map(|x| x.texrepeat).collect()),
        (
            "mat_texuniform",
            m.materials.iter().map(|x| f64::from(u8::from(x.texuniform))).collect(),
        ),
        (
            "mat_texid",
            m.materials
                .iter()
                .map(|x| x.texture.map_or(-1.0, |id| id as f64))
                .collect(),
        ),
        (
            "tex_type",
            m.textures.iter().map(|t| f64::from(t.kind.code())).collect(),
        ),
    ]
}

fn of_views(m: &Model) -> Named {
    vec![
        ("vis_global__fovy", vec![m.vis.fovy]),
        ("vis_global__offwidth", vec![m.vis.offwidth as f64]),
        ("vis_global__offheight", vec![m.vis.offheight as f64]),
        ("vis_map_znear", vec![m.vis.znear]),
        ("vis_map_zfar", vec![m.vis.zfar]),
        ("vis_map_fogstart", vec![m.vis.fogstart]),
        ("vis_map_fogend", vec![m.vis.fogend]),
        ("vis_map_haze", vec![m.vis.haze]),
        ("vis_map_shadowclip", vec![m.vis.shadowclip]),
        ("vis_map_force", vec![m.vis.force]),
        ("vis_quality_shadowsize", vec![m.vis.shadowsize as f64]),
        ("vis_quality_offsamples", vec![m.vis.offsamples as f64]),
        (
            "vis_headlight_active",
            vec![f64::from(u8::from(m.vis.headlight_active))],
        ),
        ("vis_headlight_ambient", m.vis.headlight_ambient.to_vec()),
        ("vis_headlight_diffuse", m.vis.headlight_diffuse.to_vec()),
        ("vis_headlight_specular", m.vis.headlight_specular.to_vec()),
    ]
}

/// Cuts the rows of MuJoCo's arrays to the width of ours, after checking that the rest is unused (0 or -1).
///
/// `mat_texid` holds one texture per role. The models use the second (colour).
pub fn narrowed(name: &str, recorded: &[f64]) -> Vec<f64> {
    let (wide, first, keep) = match name {
        "mat_texid" => (10, 1, 1),
        _ => return recorded.to_vec(),
    };
    let mut out = Vec::new();
    for row in recorded.chunks(wide) {
        for (column, &value) in row.iter().enumerate() {
            if (first..first + keep).contains(&column) {
                out.push(value);
            } else {
                assert!(value == 0.0 || value == -1.0, "{name}: {value} in column {column}");
            }
        }
    }
    out
}
