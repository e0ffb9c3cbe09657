//! Starts of episodes that several tasks of the library share.

use super::TaskScene;
use crate::config::Compat;
use crate::env::EnvError;

/// Random actions at the start of an episode, of one physics step each.
const RANDOM_ACTIONS: usize = 10;

/// Starts an episode from the settled state with random actions; `after` is called after each of them.
pub(super) fn random_start(
    scene: &mut TaskScene<'_>,
    mut after: impl FnMut(&mut TaskScene<'_>) -> Result<(), EnvError>,
) -> Result<(), EnvError> {
    scene.restart()?;
    for _ in 0..RANDOM_ACTIONS {
        let mut action = std::mem::take(scene.action);
        scene.actuation.action_space().sample(scene.rng, &mut action);
        let stepped = scene.act(&action, 1);
        *scene.action = action;
        stepped?;
        after(scene)?;
    }
    Ok(())
}

/// Passes the action 0 to the actuators and takes physics steps. Under `compat: reference` actuators are not updated between
/// them.
pub(super) fn relax(scene: &mut TaskScene<'_>, steps: u32) -> Result<(), EnvError> {
    if scene.config.compat == Compat::Reference {
        return scene.rest(steps);
    }
    let mut action = std::mem::take(scene.action);
    action.clear();
    action.resize(scene.actuation.action_space().len(), 0.0);
    let stepped = scene.act(&action, steps);
    *scene.action = action;
    stepped
}
