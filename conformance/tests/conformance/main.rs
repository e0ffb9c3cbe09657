//! How far babybench is from MuJoCo 3.3.0. What lacks its yardstick is reported as ignored, with the reason.

mod actuation;
mod agreement;
mod applied_forces;
mod compiled_model;
mod complete_models;
mod composed;
mod contact_free;
mod contact_gaps;
mod contact_geometry;
mod differential;
mod flexes;
mod fused_bodies;
mod growth;
mod hulls;
mod included_files;
mod kit;
mod language;
mod left_out;
mod length_ranges;
mod live_loader;
mod live_mujoco;
mod live_one_step;
mod live_rollout;
mod logs;
mod meanings;
mod mimo3;
mod mutations;
mod rapier_engine;
mod recordings;
mod refined_portals;
mod render;
#[cfg(feature = "wgpu")]
mod render_gpu;
mod replay;
mod senses;
mod settling;
mod skins;
mod static_quantities;
mod tasks;
mod textures;
mod touch;

use std::process::ExitCode;

fn main() -> ExitCode {
    let all = [
        actuation::trials(),
        applied_forces::trials(),
        compiled_model::trials(),
        complete_models::trials(),
        contact_free::trials(),
        contact_gaps::trials(),
        contact_geometry::trials(),
        differential::trials(),
        flexes::trials(),
        fused_bodies::trials(),
        language::trials(),
        left_out::trials(),
        growth::trials(),
        hulls::trials(),
        included_files::trials(),
        kit::trials(),
        length_ranges::trials(),
        live_loader::trials(),
        live_mujoco::trials(),
        live_one_step::trials(),
        live_rollout::trials(),
        logs::trials(),
        composed::trials(),
        meanings::trials(),
        mimo3::trials(),
        mutations::trials(),
        rapier_engine::trials(),
        recordings::trials(),
        refined_portals::trials(),
        render::trials(),
        #[cfg(feature = "wgpu")]
        render_gpu::trials(),
        replay::trials(),
        senses::trials(),
        settling::trials(),
        skins::trials(),
        static_quantities::trials(),
        tasks::trials(),
        textures::trials(),
        touch::trials(),
    ];
    testkit::harness::run(all.concat())
}
