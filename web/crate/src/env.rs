//! One environment.

use std::sync::Arc;

use babybench::Env;
use babybench::config::{FacialExpression, Part};
use babybench::env::{Checksum, Snapshot, ViewFrom, Viewer, draw_eyes};
use babybench::mimo::{LockReport, LockTarget, lock_of};
use babybench::model::JointType;
use babybench::render::{FreeCamera, Scenery};
use babybench::sensors::transform::Sense;
use babybench::sensors::{ObservationEntry, Touch};
use babybench::spaces::Values;
use wasm_bindgen::prelude::*;

use crate::frame::Frame;
use crate::js::{self, id, ids, list, object, optional};
use crate::numbers::{of_state, place};
use crate::scene;

/// An environment, with the data from which a page draws it.
#[wasm_bindgen]
pub struct Core {
    pub(crate) env: Env,
    scenery: Option<Arc<Scenery>>,
    viewer: Option<Viewer>,
    frame: Frame,
    /// The last random action, and where the caller may write the next one.
    action: Vec<f32>,
}

#[wasm_bindgen]
impl Core {
    pub(crate) fn new(blueprint: &babybench::Blueprint) -> Result<Core, JsValue> {
        let env = blueprint.env().map_err(|e| js::env_error(&e))?;
        Ok(Self {
            action: vec![0.0; env.action_space().len()],
            scenery: None,
            viewer: None,
            frame: Frame::default(),
            env,
        })
    }

    /// Starts an episode.
    pub fn reset(&mut self, seed: Option<u64>) -> Result<(), JsValue> {
        done(self.env.reset(seed))
    }

    /// Starts an episode from positions and velocities.
    #[wasm_bindgen(js_name = resetTo)]
    pub fn reset_to(&mut self, qpos: &[f64], qvel: &[f64]) -> Result<(), JsValue> {
        done(self.env.by_hand().reset_to(qpos, qvel))
    }

    /// Sets positions and velocities in the middle of an episode.
    #[wasm_bindgen(js_name = setState)]
    pub fn set_state(&mut self, qpos: &[f64], qvel: &[f64]) -> Result<(), JsValue> {
        done(self.env.by_hand().set_state(qpos, qvel))
    }

    /// Sets the activations of the muscles.
    #[wasm_bindgen(js_name = setActivity)]
    pub fn set_activity(&mut self, activity: &[f64]) -> Result<(), JsValue> {
        done(self.env.by_hand().set_activity(activity))
    }

    /// Steps with the action in the view `action`.
    pub fn step(&mut self) -> Result<(), JsValue> {
        self.env.step(&self.action).map(drop).map_err(|e| js::env_error(&e))
    }

    /// Draws a random action into the view `action`.
    #[wasm_bindgen(js_name = sampleAction)]
    pub fn sample_action(&mut self) {
        // the capacity suffices, so the view does not move
        self.env.sample_action(&mut self.action);
    }

    /// Seeds the generator of random actions.
    #[wasm_bindgen(js_name = seedActionSpace)]
    pub fn seed_action_space(&mut self, seed: u64) {
        self.env.by_hand().seed_action_space(seed);
    }

    /// Sets whether the eyes are drawn only on demand, by `drawEyes`.
    #[wasm_bindgen(js_name = deferVision)]
    pub fn defer_vision(&mut self, deferred: bool) {
        self.env.senses_mut().defer_vision(deferred);
    }

    /// Draws what the eyes see into the observation.
    #[wasm_bindgen(js_name = drawEyes)]
    pub fn draw_eyes(&mut self) -> Result<(), JsValue> {
        done(draw_eyes([&mut self.env]))
    }

    /// Returns the location of numbers: kind (1 for u8, 4 for f32, 5 for i32, 8 for f64), address, length. The location stays valid until a snapshot
    /// is restored; numbers of the frame move with `update`.
    pub fn view(&self, name: &str) -> Option<Vec<u32>> {
        let seen = self.env.observation();
        let entry = seen.entries().find(|(entry, _)| entry.field == name);
        let values = match name {
            "action" => Values::F32(&self.action),
            "poses" => Values::F32(&self.frame.poses),
            "bodies" => Values::F32(&self.frame.bodies),
            "felt" => Values::F32(&self.frame.felt),
            "contacts" => Values::F32(&self.frame.contacts),
            "worn" => Values::F32(&self.frame.worn),
            _ => match entry {
                Some((_, values)) => values,
                None => of_state(self.env.state(), name)?,
            },
        };
        Some(place(values).to_vec())
    }

    /// Names the views of every entry that an observation may have.
    #[wasm_bindgen(js_name = observationNames)]
    pub fn observation_names(&self) -> Vec<String> {
        let entries = ObservationEntry::ALL.iter();
        entries.map(|entry| entry.field.to_string()).collect()
    }

    /// Describes the entries of the current observation: property, Gymnasium's key, shape, number type and bounds.
    #[wasm_bindgen(js_name = observationSpace)]
    pub fn observation_space(&self) -> JsValue {
        let field = |key: &str| ObservationEntry::of_key(key).map_or_else(String::new, |entry| entry.field.to_string());
        list(self.env.observation_space().into_iter().map(|space| {
            object([
                ("name", field(space.key).into()),
                ("key", space.key.into()),
                ("shape", ids(&space.shape)),
                ("dtype", space.dtype.name().into()),
                ("low", space.low.into()),
                ("high", space.high.into()),
            ])
        }))
    }

    /// Returns the time between two steps, s.
    pub fn dt(&self) -> f64 {
        self.env.blueprint().dt()
    }

    /// Updates the views of the frame: `poses`, `bodies`, `felt`, `contacts`, `worn`.
    pub fn update(&mut self) -> Result<(), JsValue> {
        let scenery = self.scenery()?;
        let touch = self.env.senses().touch();
        self.frame.update(self.env.model(), &scenery, self.env.state(), touch);
        Ok(())
    }

    /// Describes bodies, joints, cameras and actions.
    pub fn model(&self) -> JsValue {
        scene::model(&self.env)
    }

    /// Describes the drawables and the light.
    pub fn look(&mut self) -> Result<JsValue, JsValue> {
        let scenery = self.scenery()?;
        Ok(scene::look(self.env.model(), &scenery))
    }

    /// Returns the location of the pixels of a texture's image: address and length in bytes, red, green, blue and 255.
    #[wasm_bindgen(js_name = texturePixels)]
    pub fn texture_pixels(&mut self, texture: usize, face: usize) -> Result<Option<Vec<u32>>, JsValue> {
        let scenery = self.scenery()?;
        let faces = scenery.textures.get(texture).map(scene::faces);
        let level = faces.and_then(|f| f.get(face)).and_then(|levels| levels.first());
        Ok(level.map(|l| place(Values::U8(l.pixels.as_flattened())).to_vec()))
    }

    /// Returns the position of each touch sensor in the frame of its body, m.
    #[wasm_bindgen(js_name = skinPositions)]
    pub fn skin_positions(&self) -> Vec<f32> {
        let bodies = self.env.senses().touch().into_iter().flat_map(|t| t.layout().bodies());
        let points = bodies.flat_map(|b| b.positions().as_flattened());
        points.map(|&v| v as f32).collect()
    }

    /// Returns the body of each touch sensor.
    #[wasm_bindgen(js_name = skinBodies)]
    pub fn skin_bodies(&self) -> Vec<u32> {
        let bodies = self.env.senses().touch().into_iter().flat_map(|t| t.layout().bodies());
        bodies.flat_map(|b| vec![b.body as u32; b.len()]).collect()
    }

    /// Returns the number of values of a touch sensor, 0 without touch.
    #[wasm_bindgen(js_name = touchWidth)]
    pub fn touch_width(&self) -> usize {
        self.env.senses().touch().map_or(0, Touch::width)
    }

    /// Names the values of proprioception, in order.
    #[wasm_bindgen(js_name = proprioceptionNames)]
    pub fn proprioception_names(&self) -> JsValue {
        let entries = self
            .env
            .senses()
            .proprioception()
            .entries(self.env.model(), self.env.blueprint().actuation());
        list(entries.iter().map(|e| {
            object([
                ("component", e.component.name().into()),
                ("name", e.name.as_str().into()),
                ("start", id(e.range.start)),
                ("end", id(e.range.end)),
            ])
        }))
    }

    /// Returns the information of the last step.
    pub fn info(&self) -> JsValue {
        let info = self.env.info();
        let (touches, task) = (info.behavior.touches(), info.behavior.task());
        let parts = info.details.touched_parts.as_ref().map(|p| p.each_ref());
        let hands = |make: &dyn Fn(usize) -> JsValue| object([("right_hand", make(0)), ("left_hand", make(1))]);
        object([
            ("steps", (info.steps as f64).into()),
            ("behavior", info.behavior.name().into()),
            ("touches", optional(touches, |t| hands(&|hand| ids(t[hand])))),
            (
                "touched_parts",
                optional(parts, |p| {
                    hands(&|hand| list(p[hand].iter().map(|name| JsValue::from(&**name))))
                }),
            ),
            (
                "regards",
                optional(info.behavior.regards(), |counts| js::numbers(&counts.map(|c| c as f64))),
            ),
            (
                "page_regards",
                optional(info.details.regards, |both| {
                    js::numbers(&both.page.to_array().map(|c| c as f64))
                }),
            ),
            (
                "kit_regards",
                optional(info.details.regards, |both| {
                    js::numbers(&both.kit.to_array().map(|c| c as f64))
                }),
            ),
            ("score", optional(info.behavior.score(info.steps), JsValue::from)),
            ("is_success", optional(task, |t| t.outcome.is_success.into())),
            ("is_failure", optional(task, |t| t.outcome.is_failure.into())),
            ("return", optional(task, |t| t.episode_return.into())),
            ("reward_terms", optional(task, |_| js::numbers(self.env.goal().terms))),
            (
                "measures",
                optional(task, |t| {
                    let values = js_sys::Object::new();
                    for (name, value) in t.measures.iter() {
                        // setting a property of a fresh object cannot fail
                        let _ = js_sys::Reflect::set(&values, &name.into(), &value.into());
                    }
                    values.into()
                }),
            ),
            (
                "gaze_angles",
                optional(info.details.gaze_angles, |angles| js::numbers(&angles.to_array())),
            ),
            ("age", optional(info.details.age, JsValue::from)),
            (
                "reflexes",
                optional(info.details.reflexes, |shares| {
                    let values = js_sys::Object::new();
                    for reflex in self.env.reflexes() {
                        let share = shares.get(reflex).unwrap_or_default();
                        // setting a property of a fresh object cannot fail
                        let _ = js_sys::Reflect::set(&values, &reflex.name().into(), &share.into());
                    }
                    values.into()
                }),
            ),
        ])
    }

    /// Locks a joint, or all joints of a part, at an angle in rad.
    pub fn lock(&mut self, target: &str, angle: f64) -> Result<JsValue, JsValue> {
        let report = self.env.mimo_mut().lock(lock_target(target), angle);
        report.map(|r| self.report(&r)).map_err(|e| js::env_error(&e))
    }

    /// Unlocks a joint, or all joints of a part.
    pub fn unlock(&mut self, target: &str) -> Result<JsValue, JsValue> {
        let report = self.env.mimo_mut().unlock(lock_target(target));
        report.map(|r| self.report(&r)).map_err(|e| js::env_error(&e))
    }

    /// Changes MIMo's face. Returns the configuration as YAML.
    #[wasm_bindgen(js_name = swapFacialExpression)]
    pub fn swap_facial_expression(&mut self, name: &str) -> Result<String, JsValue> {
        let face = FacialExpression::from_name(name).ok_or_else(|| js::error("there is no such face"))?;
        done(self.env.mimo_mut().swap_facial_expression(face))?;
        (self.scenery, self.viewer) = (None, None);
        Ok(self.env.config().to_yaml())
    }

    /// Lists the locked joints by id.
    pub fn locked(&self) -> Vec<u32> {
        let (m, active) = (self.env.model(), &self.env.state().params.eq_active);
        let hinges = (0..m.njnt()).filter(|&j| m.jnt_type[j] != JointType::Free);
        let locked = hinges.filter(|&j| lock_of(m, j).is_some_and(|e| active[e]));
        locked.map(|j| j as u32).collect()
    }

    /// Takes a snapshot.
    pub fn snapshot(&self) -> Vec<u8> {
        self.env.snapshot().as_bytes().to_vec()
    }

    /// Restores a snapshot, with poses, contacts, forces and touch recomputed, so that they can be drawn immediately, and the rest of the
    /// observation as it was, so that a network that reads it continues with the same bits.
    pub fn restore(&mut self, bytes: Vec<u8>) -> Result<(), JsValue> {
        let snapshot = Snapshot::from_bytes(bytes).map_err(js::error)?;
        done(self.env.by_hand().resume(&snapshot))
    }

    /// Adds a force and a torque at a point, in the world, to those on a body.
    #[wasm_bindgen(js_name = applyForce)]
    pub fn apply_force(&mut self, body: usize, force: &[f64], torque: &[f64], point: &[f64]) -> Result<(), JsValue> {
        let (force, torque, point) = (three("force", force)?, three("torque", torque)?, three("point", point)?);
        let state = self.env.state_mut();
        state.apply_force(body, force, torque, point).map_err(js::error)
    }

    /// Removes all applied forces.
    #[wasm_bindgen(js_name = releaseForces)]
    pub fn release_forces(&mut self) {
        self.env.state_mut().release_forces();
    }

    /// Draws from a camera of the scene or, with `free` (lookat, distance, azimuth, elevation), from a free camera. Returns the location
    /// of the pixels: address and length in bytes, red, green, blue and 255.
    pub fn draw(
        &mut self,
        camera: &str,
        free: Option<Vec<f64>>,
        width: usize,
        height: usize,
    ) -> Result<Vec<u32>, JsValue> {
        let from = match free.as_deref() {
            None => ViewFrom::Camera(camera),
            Some(&[x, y, z, distance, azimuth, elevation]) => ViewFrom::Free(FreeCamera {
                lookat: [x, y, z],
                distance,
                azimuth,
                elevation,
            }),
            Some(other) => return Err(js::error(format!("a free camera has 6 numbers, not {}", other.len()))),
        };
        let mut viewer = self.take_viewer()?;
        let pixels = viewer.draw_rgba(&self.env, from, width, height);
        let place = pixels.map(|pixels| place(Values::U8(pixels))[1..].to_vec());
        self.viewer = Some(viewer);
        place.map_err(|e| js::env_error(&e))
    }

    /// Draws the current view of both eyes, with their acuity and foveation, without changing the observation. Returns the location of
    /// the pixels of the left and then the right picture, like `draw`.
    #[wasm_bindgen(js_name = lookThroughEyes)]
    pub fn look_through_eyes(&mut self) -> Result<Vec<u32>, JsValue> {
        let mut viewer = self.take_viewer()?;
        let place = viewer
            .eyes_rgba(&self.env)
            .map(|pixels| place(Values::U8(pixels))[1..].to_vec());
        self.viewer = Some(viewer);
        place.map_err(|e| js::env_error(&e))
    }

    /// Returns width and height of the left eye's pictures, and of the right one's, pixels.
    #[wasm_bindgen(js_name = eyeSizes)]
    pub fn eye_sizes(&self) -> Vec<u32> {
        let sizes = self.env.config().eye_sizes();
        sizes.into_iter().flatten().map(|pixels| pixels as u32).collect()
    }

    /// Returns the delay of vision, in steps.
    #[wasm_bindgen(js_name = visionDelay)]
    pub fn vision_delay(&self) -> u32 {
        self.env.blueprint().sense_delay(Sense::EyeLeft) as u32
    }

    /// Returns the checksum of positions, velocities and senses, as `examples/checksum` prints it.
    pub fn checksum(&self) -> String {
        Checksum::of(&self.env).to_string()
    }

    /// Returns the simulated time, s.
    pub fn time(&self) -> f64 {
        self.env.state().time
    }
}

impl Core {
    /// Returns the look of the scene, made on first use.
    fn scenery(&mut self) -> Result<Arc<Scenery>, JsValue> {
        if let Some(scenery) = &self.scenery {
            return Ok(scenery.clone());
        }
        let scenery = self.env.blueprint().scenery().map_err(|e| js::env_error(&e))?;
        Ok(self.scenery.insert(scenery).clone())
    }

    /// Removes and returns the viewer, which is made on first use.
    fn take_viewer(&mut self) -> Result<Viewer, JsValue> {
        let viewer = self.viewer.take().map(Ok);
        viewer.unwrap_or_else(|| Viewer::new(self.env.blueprint()).map_err(|e| js::env_error(&e)))
    }

    /// Describes the joints that a lock changed, by name.
    fn report(&self, report: &LockReport) -> JsValue {
        let names = &self.env.model().jnt_name;
        let named = |joints: &[usize]| list(joints.iter().map(|&j| names[j].as_str()));
        let held: Vec<usize> = report.held.iter().map(|&(joint, _)| joint).collect();
        object([
            ("changed", named(&report.changed)),
            ("held", named(&held)),
            ("beyond_limits", named(&report.beyond_limits)),
        ])
    }
}

/// Drops the result of a call and converts its error to an `Error`.
fn done<T>(result: Result<T, babybench::EnvError>) -> Result<(), JsValue> {
    result.map(drop).map_err(|e| js::env_error(&e))
}

/// Reads a part, such as `hands`, or the name of a joint.
fn lock_target(text: &str) -> LockTarget<'_> {
    let part = Part::ALL.into_iter().find(|p| p.name() == text);
    part.map_or(LockTarget::Name(text), LockTarget::Part)
}

fn three(what: &str, values: &[f64]) -> Result<[f64; 3], JsValue> {
    let found = values.len();
    <[f64; 3]>::try_from(values).map_err(|_| js::error(format!("{what} has {found} values but needs 3")))
}
