//! The page.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::curve::curve;
use super::doll::{self, Doll, Side};
use super::gaze::Gaze;
use super::run::{Evaluated, Run};
use super::strip::{frames, moments};
use crate::config::{Behavior, Compat, Config, Scene};
use crate::env::{BehaviorInfo, PartNames};
use crate::eval::scores::{Score, ScoreParts, Touchables};
use crate::mimo::{Version, embedded};
use crate::mjcf_loader::{DirAssets, Overlay};

const STYLE: &str = include_str!("style.css");
/// The hands: name, class, colour.
const HANDS: [(&str, &str, [f32; 3]); 2] = [
    ("right hand", "right", [0.894, 0.341, 0.18]),
    ("left hand", "left", [0.18, 0.525, 0.87]),
];
/// Parts that the hand touches least are this far between no colour and the full one.
const FAINT: f32 = 0.3;
/// Parts that are always listed; the others can be unfolded.
const LISTED: usize = 10;
/// Parts that can be touched, parts that cannot, the palm itself.
const PLAIN: [f32; 3] = [0.87, 0.87, 0.89];
const OUT_OF_REACH: [f32; 3] = [0.72, 0.73, 0.76];
const PALM: [f32; 3] = [0.25, 0.28, 0.34];

/// A file as an address.
fn embed(kind: &str, bytes: &[u8]) -> String {
    let mut out = format!("data:image/{kind};base64,");
    STANDARD.encode_string(bytes, &mut out);
    out
}

fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

/// Seconds of simulated time in words.
fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 120.0 => format!("{s:.1} s"),
        s if s < 7200.0 => format!("{:.1} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}

/// A number with thin spaces between thousands.
fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut out = String::new();
    for (k, c) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) {
            out.push('\u{202f}');
        }
        out.push(c);
    }
    out
}

fn title(run: &Run) -> String {
    let behavior = match run.behavior {
        Behavior::SelfTouch => "Self-touch",
        Behavior::HandRegard => "Hand regard",
        Behavior::None => "MIMo",
    };
    match run.config.as_ref().map(|c| c.scene) {
        Some(Scene::Crib) => format!("{behavior} in the crib"),
        Some(Scene::Cubes) => format!("{behavior} among the cubes"),
        Some(Scene::Base) => format!("{behavior} on the floor"),
        None => behavior.to_string(),
    }
}

/// Simulated seconds of a step.
fn step_time(run: &Run) -> f64 {
    let skip = run.config.as_ref().map_or(1, |c| c.frame_skip);
    run.model.as_ref().map_or(0.005, |m| m.opt.timestep) * f64::from(skip)
}

/// The whole page. Adds notices of what could not be drawn.
pub(super) fn page(run: &mut Run) -> String {
    let body = match run.behavior {
        Behavior::SelfTouch => touch_section(run),
        Behavior::HandRegard => gaze_section(run),
        Behavior::None => html! {},
    };
    let evaluation = evaluation_section(run);
    let markup = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (title(run)) " – BabyBench report" }
                style { (PreEscaped(STYLE)) }
            }
            body {
                (header(run))
                main {
                    @if !run.notices.is_empty() {
                        aside { @for notice in &run.notices { p { (notice) } } }
                    }
                    (score_section(run))
                    (curve_section(run))
                    (body)
                    (evaluation)
                    @if let Some(config) = &run.config { (config_section(config)) }
                }
                footer { "Written by babybench " (env!("CARGO_PKG_VERSION")) }
            }
        }
    };
    markup.into_string()
}

fn header(run: &Run) -> Markup {
    let about = run.config.as_ref().map(|c| {
        let version = Version::of(c.behavior).name();
        format!(
            "MIMo {version} · {} · compat: {}",
            c.actuation_model.name().replace('_', " "),
            c.compat
        )
    });
    html! {
        header {
            p.over { "BabyBench report" }
            h1 { (title(run)) }
            p.under { (run.dir.display()) @if let Some(about) = about { " · " (about) } }
        }
    }
}

fn card(value: &str, what: &str) -> Markup {
    html! { div.card { b { (value) } span { (what) } } }
}

fn score_section(run: &Run) -> Markup {
    let Some(score) = &run.score else {
        return html! {};
    };
    let best = match (&score.parts, &run.touchables) {
        (ScoreParts::SelfTouch(_), Some(t)) => {
            let reachable = [0, 1].map(|hand| t.reachable(hand).len());
            Score::of_parts(reachable[0] + reachable[1])
        }
        _ => 1.0,
    };
    html! {
        section {
            h2 { "Preliminary training score" }
            div.cards {
                div.card.big {
                    b { (format!("{:.3}", score.value)) }
                    div.bar { i style=(format!("width:{:.1}%", 100.0 * (score.value / best).min(1.0))) {} }
                    span { "of " (format!("{best:.3}")) " at best" }
                }
                (card(&grouped(score.episodes as u64), "episodes counted"))
                (card(&grouped(score.steps), "steps"))
                (card(&duration(score.steps as f64 * step_time(run)), "simulated"))
                @match &score.parts {
                    ScoreParts::SelfTouch(touched) => {
                        @for (hand, (name, ..)) in HANDS.iter().enumerate() {
                            (card(&touched[hand].len().to_string(), &format!("parts, {name}")))
                        }
                    }
                    ScoreParts::HandRegard(_) => {}
                }
            }
            @if let Some(fractions) = score.fractions() { (fractions_table(&fractions)) }
        }
    }
}

/// Shares of the steps of the four pairs.
fn fractions_table(fractions: &[f64; 4]) -> Markup {
    let most = fractions.iter().fold(0.01, |m: f64, f| m.max(*f));
    html! {
        table.bars {
            @for (k, name) in BehaviorInfo::REGARDS.iter().enumerate() {
                tr {
                    th { (name.replacen("eye_", "eye, ", 1).replace('_', " ")) }
                    td.wide { div.bar.(HANDS[k % 2].1) { i style=(format!("width:{:.1}%", 100.0 * fractions[k] / most)) {} } }
                    td.number { (format!("{:.2} %", 100.0 * fractions[k])) }
                }
            }
        }
    }
}

fn curve_section(run: &Run) -> Markup {
    let reachable = run.touchables.as_ref().map_or(31, |t| t.reachable(0).len());
    let Some(chart) = curve(run.counted(), reachable) else {
        return html! {};
    };
    let what = match run.behavior {
        Behavior::SelfTouch => "Different parts of the body that each palm has touched so far.",
        _ => "Share of the steps with the hand in the central field of view, mean over the last episodes.",
    };
    html! {
        section {
            h2 { "Learning curve" }
            p { (what) " As in the score, the first record of the log does not count." }
            figure.chart { (chart) }
        }
    }
}

fn mix(a: [f32; 3], b: [f32; 3], t: f32) -> [f32; 3] {
    std::array::from_fn(|k| a[k] + (b[k] - a[k]) * t)
}

fn touch_section(run: &mut Run) -> Markup {
    let touched = run.touched();
    let (Some(model), Some(touchables)) = (&run.model, &run.touchables) else {
        run.notices
            .push("Touched parts are not drawn: the scene of the run has no MIMo that is known here.".to_string());
        return html! {};
    };
    let assets = DirAssets::new(&run.dir).ok();
    let mut doll = match &assets {
        Some(assets) => Doll::new(model, &Overlay::new(vec![assets, &embedded()])),
        None => Doll::new(model, &embedded()),
    };
    let palms = ["right_hand", "left_hand"].map(|name| model.body(name).map(|b| b.0));
    let mut picture = |hand: usize, side: Side| -> Option<String> {
        let color = |g: usize| {
            if Some(model.geom_bodyid[g]) == palms[hand] {
                return PALM;
            }
            match touched[hand].iter().find(|(geom, _)| *geom == g) {
                Some((_, share)) => mix(PLAIN, HANDS[hand].2, FAINT + (1.0 - FAINT) * share.sqrt() as f32),
                None if touchables.reachable(hand).contains(&g) => PLAIN,
                None => OUT_OF_REACH,
            }
        };
        Some(embed("png", &doll.as_mut()?.draw(side, &color)?))
    };
    let pictures = [0, 1].map(|hand| [Side::Front, Side::Back].map(|side| (side, picture(hand, side))));
    let source = if run.counted().is_empty() {
        "evaluation"
    } else {
        "training"
    };
    let mut parts: Vec<(usize, [f64; 2])> = (0..model.ngeom())
        .filter(|g| [0, 1].iter().any(|&hand| touchables.reachable(hand).contains(g)))
        .map(|g| {
            (
                g,
                [0, 1].map(|hand| {
                    touched[hand]
                        .iter()
                        .find(|(t, _)| *t == g)
                        .map_or(0.0, |(_, share)| *share)
                }),
            )
        })
        .collect();
    parts.sort_by(|a, b| (b.1[0] + b.1[1]).total_cmp(&(a.1[0] + a.1[1])));
    let (some, none): (Vec<_>, Vec<_>) = parts.into_iter().partition(|(_, s)| s[0] + s[1] > 0.0);
    html! {
        section {
            h2 { "What the hands touched" }
            p { "In " (source) ": the fuller the colour, the more episodes with a touch. Dark: the palm that touches. "
                "Grey: out of its reach." }
            div.dolls {
                @for (hand, sides) in pictures.iter().enumerate() {
                    figure {
                        div.pair {
                            @for (side, picture) in sides {
                                @if let Some(picture) = picture {
                                    img src=(picture) width=(doll::WIDTH) height=(doll::HEIGHT)
                                        alt=(format!("MIMo from the {}, parts touched by the {} in colour",
                                            if *side == Side::Front { "front" } else { "back" }, HANDS[hand].0));
                                }
                            }
                        }
                        figcaption.(HANDS[hand].1) {
                            b { (HANDS[hand].0) } ", from the front and from the back: "
                            (touched[hand].len()) " of " (touchables.reachable(hand).len()) " parts in reach"
                        }
                    }
                }
            }
            @if !some.is_empty() { (parts_table(touchables, &some[..some.len().min(LISTED)])) }
            @if some.len() > LISTED {
                details {
                    summary { (some.len() - LISTED) " more parts" }
                    (parts_table(touchables, &some[LISTED..]))
                }
            }
            @if !none.is_empty() {
                details {
                    summary { (none.len()) " parts that neither hand has touched yet" }
                    p { @for (k, (geom, _)) in none.iter().enumerate() {
                        @if k > 0 { ", " } (touchables.name(*geom).replace('_', " ")) } }
                }
            }
        }
    }
}

/// How often each part was touched by each hand.
fn parts_table(touchables: &Touchables, parts: &[(usize, [f64; 2])]) -> Markup {
    html! {
        table.bars {
            thead { tr { th { "part" } th { "share of episodes" } th.number { "right" } th.number { "left" } } }
            @for (geom, shares) in parts {
                tr {
                    th { (touchables.name(*geom).replace('_', " ")) }
                    td.wide {
                        @for (hand, share) in shares.iter().enumerate() {
                            div.bar.(HANDS[hand].1) { i style=(format!("width:{:.1}%", 100.0 * share)) {} }
                        }
                    }
                    @for share in shares { td.number { @if *share > 0.0 { (percent(*share)) } @else { "–" } } }
                }
            }
        }
    }
}

fn gaze_section(run: &mut Run) -> Markup {
    let compat = run.config.as_ref().map_or(Compat::Api, |c| c.compat);
    let gaze = run.model.as_ref().and_then(|m| Gaze::new(m, &run.evaluations, compat));
    let Some(gaze) = gaze else {
        if !run.evaluations.is_empty() {
            run.notices
                .push("There is no gaze map: the scene of the run does not fit the evaluation logs.".to_string());
        }
        return html! {};
    };
    html! {
        section {
            h2 { "Where the eyes saw the hands" }
            p { "In evaluation, " (grouped(gaze.steps as u64)) " steps: directions of the hands from each eye, as angles from "
                "where it looks. Dashed circle: the field of view that is scored"
                @if compat == Compat::Reference { " (under compat: reference, it lies below the gaze)" }
                ". Thin line: the border of the eye's image." }
            div.maps {
                @for (eye, name) in [(1, "left eye"), (0, "right eye")] {
                    figure { (gaze.map(eye)) figcaption { b { (name) } } }
                }
            }
            p.legend { @for (name, class, _) in HANDS { span.key.(class) { (name) } } }
        }
    }
}

/// What an evaluation episode is worth alone.
fn episode_score(evaluated: &Evaluated) -> Option<f64> {
    Score::of_episode(evaluated.log.info.last()?, evaluated.log.len() as u64)
}

fn evaluation_section(run: &mut Run) -> Markup {
    if run.evaluations.is_empty() {
        return html! {};
    }
    let scores: Vec<Option<f64>> = run.evaluations.iter().map(episode_score).collect();
    let with_video = || run.evaluations.iter().zip(&scores).filter(|(e, _)| e.video.is_some());
    let best = with_video().max_by(|a, b| {
        a.1.unwrap_or(0.0)
            .total_cmp(&b.1.unwrap_or(0.0))
            .then(b.0.episode.cmp(&a.0.episode))
    });
    let mut notice = None;
    let strip = match best {
        Some((evaluated, _)) => strip(run, evaluated).unwrap_or_else(|e| {
            notice = Some(format!("Key frames of evaluation episode {}: {e}.", evaluated.episode));
            html! {}
        }),
        None => {
            notice = Some("There is no video: babybench evaluate without --no-render makes one.".to_string());
            html! {}
        }
    };
    let markup = html! {
        section {
            h2 { "Evaluation" }
            (strip)
            (evaluation_table(run, &scores))
        }
    };
    run.notices.extend(notice);
    markup
}

/// Key frames of a video.
fn strip(run: &Run, evaluated: &Evaluated) -> std::io::Result<Markup> {
    let Some(path) = &evaluated.video else {
        return Ok(html! {});
    };
    let names = run.model.as_ref().map(PartNames::new);
    let moments = moments(&evaluated.log, names.as_ref());
    let numbers: Vec<usize> = moments.iter().map(|m| m.step).collect();
    let frames = frames(path, &numbers)?;
    let panel = match run.behavior {
        Behavior::SelfTouch => "the skin",
        Behavior::HandRegard => "what both eyes see",
        Behavior::None => "the room from the side",
    };
    let seen = |step: usize, event: &str| match event {
        "" => format!("step {}: the room, MIMo from above and {panel}", step + 1),
        event => format!("step {}, {event}: the room, MIMo from above and {panel}", step + 1),
    };
    let text = |step: usize| moments.iter().find(|m| m.step == step).map_or("", |m| m.text.as_str());
    Ok(html! {
        p { "Moments of episode " (evaluated.episode) ", from " code { (path.display()) } "." }
        div.strip {
            @for (step, jpeg) in &frames {
                figure {
                    img src=(embed("jpeg", jpeg)) alt=(seen(*step, text(*step))) loading="lazy";
                    figcaption {
                        b { "step " (step + 1) } (format!(" · {:.2} s", (*step as f64 + 1.0) * step_time(run)))
                        @if !text(*step).is_empty() { br; (text(*step)) }
                    }
                }
            }
        }
    })
}

fn evaluation_table(run: &Run, scores: &[Option<f64>]) -> Markup {
    let touch = run.behavior == Behavior::SelfTouch;
    let regard = run.behavior == Behavior::HandRegard;
    html! {
        div.scroll { table {
            thead { tr {
                th { "episode" } th.number { "steps" }
                @if touch { th.number { "parts, right" } th.number { "parts, left" } }
                @if regard { @for name in BehaviorInfo::REGARDS { th.number { (name.replacen("eye_", "eye, ", 1).replace('_', " ")) } } }
                @if touch || regard { th.number { "score of the episode" } }
            } }
            @for (evaluated, score) in run.evaluations.iter().zip(scores) {
                @let steps = evaluated.log.len();
                tr {
                    td { (evaluated.episode) } td.number { (grouped(steps as u64)) }
                    @if let Some(info) = evaluated.log.info.last() {
                        @if let Some(touches) = info.behavior.touches() {
                            @for list in touches { td.number { (list.len()) } }
                        }
                        @if let Some(counts) = info.behavior.regards() {
                            @for n in counts { td.number { (percent(n as f64 / steps as f64)) } }
                        }
                    }
                    @if let Some(score) = score { td.number { b { (format!("{score:.3}")) } } }
                }
            }
        } }
        @if run.config.as_ref().is_some_and(|c| c.compat == Compat::Reference) && run.evaluations.len() > 1 {
            p.note { "Under compat: reference the counters go on from episode to episode." }
        }
    }
}

fn config_section(config: &Config) -> Markup {
    let yaml = config.to_yaml();
    let lines = yaml
        .lines()
        .filter(|l| !l.starts_with('#'))
        .filter_map(|l| l.split_once(':'));
    html! {
        section {
            h2 { "Configuration" }
            details {
                summary { "all keys" }
                dl.config { @for (key, value) in lines { div { dt { (key.trim()) } dd { (value.trim()) } } } }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        assert_eq!(grouped(7), "7");
        assert_eq!(grouped(1234567), "1\u{202f}234\u{202f}567");
        assert_eq!(duration(50.0), "50.0 s");
        assert_eq!(duration(600.0), "10.0 min");
        assert_eq!(duration(36000.0), "10.0 h");
    }
}
