//! The section about evaluation episodes.

use maud::{Markup, html};

use super::{embed, grouped, percent, step_time};
use crate::config::{Behavior, Compat};
use crate::env::{EYE_HAND_PAIRS, Outcome, PartNames};
use crate::eval::Score;
use crate::report::run::{Evaluated, Run};
use crate::report::strip::{frames, moments};

/// Returns the score that an evaluation episode has alone.
fn episode_score(evaluated: &Evaluated) -> Option<f64> {
    Score::of_episode(evaluated.log.info.last()?, evaluated.log.len() as u64)
}

/// Draws the section: key frames of the best episode with a video, and a table of all.
pub(super) fn evaluation_section(run: &mut Run) -> Markup {
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
            notice = Some("No video yet; babybench evaluate without --no-render makes one.".to_string());
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

/// Draws key frames of a video.
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
        _ => "the room from the side",
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

/// Says how an episode of a task ended.
fn outcome(outcome: &Outcome) -> &'static str {
    match (outcome.is_success, outcome.is_failure) {
        (true, _) => "success",
        (_, true) => "failure",
        _ => "neither",
    }
}

/// Draws the table of all episodes.
fn evaluation_table(run: &Run, scores: &[Option<f64>]) -> Markup {
    let touch = run.behavior == Behavior::SelfTouch;
    let regard = run.behavior == Behavior::HandRegard;
    let of_task = |e: &Evaluated| e.log.info.last().is_some_and(|info| info.behavior.task().is_some());
    let task = run.evaluations.iter().any(of_task);
    html! {
        div.scroll { table {
            thead { tr {
                th { "episode" } th.number { "steps" }
                @if touch { th.number { "parts, right" } th.number { "parts, left" } }
                @if regard { @for name in EYE_HAND_PAIRS { th.number { (name.replacen("eye_", "eye, ", 1).replace('_', " ")) } } }
                @if touch || regard { th.number { "score of the episode" } }
                @if task { th.number { "return" } th { "outcome" } }
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
                        @if let Some(task) = info.behavior.task() {
                            td.number { (format!("{:.3}", task.episode_return)) }
                            td { (outcome(&task.outcome)) }
                        }
                    }
                    @if let Some(score) = score { td.number { b { (format!("{score:.3}")) } } }
                }
            }
        } }
        @if run.config.as_ref().is_some_and(|c| c.compat == Compat::Reference) && run.evaluations.len() > 1 {
            p.note { "Under compat: reference counters carry over from episode to episode." }
        }
    }
}
