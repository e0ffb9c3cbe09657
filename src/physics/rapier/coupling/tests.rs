//! Tests of couplings.

use mjcf_sim_loader::edit::Document;
use mjcf_sim_model::assets::MemoryAssets;
use rapier3d_f64::parry::utils::Array2;
use rapier3d_f64::prelude::*;

use super::*;

/// A world without gravity, with steps of 5 ms.
fn world() -> PhysicsWorld {
    let mut world = PhysicsWorld::new();
    world.gravity = Vector::ZERO;
    world.integration_parameters.dt = 0.005;
    world
}

fn join(mjcf: &str, world: &mut PhysicsWorld, frame: Pose, options: CouplingOptions) -> CoupledSimulation {
    let document = Document::read_str(mjcf, "model.xml", &MemoryAssets::new()).expect("a document");
    CoupledSimulation::join(
        &document,
        &MemoryAssets::new(),
        &mut WorldSets::from(world),
        frame,
        options,
    )
    .expect("joins")
}

fn step(model: &mut CoupledSimulation, world: &mut PhysicsWorld) {
    model.step(&mut WorldSets::from(&mut *world)).expect("a step");
    world.step();
}

/// Copies the state from which a world continues.
fn copy_of(world: &PhysicsWorld) -> PhysicsWorld {
    let mut copy = PhysicsWorld::new();
    copy.gravity = world.gravity;
    copy.integration_parameters = world.integration_parameters;
    copy.islands = world.islands.clone();
    copy.broad_phase = world.broad_phase.clone();
    copy.narrow_phase = world.narrow_phase.clone();
    copy.bodies = world.bodies.clone();
    copy.colliders = world.colliders.clone();
    copy.impulse_joints = world.impulse_joints.clone();
    copy.multibody_joints = world.multibody_joints.clone();
    copy
}

fn down(world: &mut PhysicsWorld) {
    world.gravity = Vector::new(0.0, 0.0, -9.81);
}

/// A floating cup with a piston for a floor.
const CUP: &str = "<mujoco><option timestep='.005'/><worldbody><body name='cup'><freejoint/>
    <geom type='box' size='.2 .01 .1' pos='0 .2 .1' mass='.5'/><geom type='box' size='.2 .01 .1' pos='0 -.2 .1' mass='.5'/>
    <geom type='box' size='.01 .2 .1' pos='.2 0 .1' mass='.5'/><geom type='box' size='.01 .2 .1' pos='-.2 0 .1' mass='.5'/>
    <body name='piston'><joint type='slide' axis='0 0 1' stiffness='100' damping='5'/>
    <geom type='box' size='.15 .15 .01' mass='.3'/></body></body></worldbody>
    <actuator><motor joint='' /></actuator></mujoco>";

#[test]
fn a_throw_and_a_catch_conserve_momentum() {
    let mjcf = CUP
        .replace("type='slide'", "name='lift' type='slide'")
        .replace("joint=''", "joint='lift'");
    let mut world = world();
    let ball = RigidBodyBuilder::dynamic()
        .translation(Vector::new(0.0, 0.0, 0.4))
        .linvel(Vector::new(0.0, 0.0, -2.0));
    let (ball, _) = world.insert(ball, ColliderBuilder::ball(0.05).density(1000.0));
    let mut cup = join(&mjcf, &mut world, Pose::IDENTITY, CouplingOptions::default());
    let mass = world.bodies[ball].mass();
    let momentum = |world: &PhysicsWorld, cup: &CoupledSimulation| {
        let v = &cup.state.qvel;
        let own = [2.3 * v[0], 2.3 * v[1], 2.3 * v[2] + 0.3 * v[6]];
        world.bodies[ball].linvel() * mass + exchange::vector(own)
    };
    let before = momentum(&world, &cup);
    let scale = before.length();
    let (mut touched, mut slowest) = (0, f64::NEG_INFINITY);
    for k in 0..400 {
        cup.state.ctrl[0] = if (100..130).contains(&k) { 60.0 } else { 0.0 };
        step(&mut cup, &mut world);
        cup.finish(&mut WorldSets::from(&mut world));
        let [impulse, _] = cup.coupling().impulse_on(ball);
        touched += usize::from(impulse != Vector::ZERO);
        slowest = slowest.max(world.bodies[ball].linvel().z);
        let off = (momentum(&world, &cup) - before).length() / scale;
        assert!(off < 1e-9, "step {k}: {off:e}");
    }
    assert!(touched > 20, "the ball was caught in {touched} steps");
    assert!(slowest > 1.0, "the ball was thrown at {slowest} m/s");
}

#[test]
fn a_ball_rests_on_a_bowl_as_in_the_model_alone() {
    // three spheres hold a ball
    let bowl = "<mujoco><option timestep='.005'/><worldbody><body name='bowl' pos='0 0 .5'><joint type='slide' axis='0 0 1' stiffness='500' damping='30'/>
        <geom size='.06' pos='.07 0 0' mass='.3'/><geom size='.06' pos='-.035 .06062 0' mass='.3'/><geom size='.06' pos='-.035 -.06062 0' mass='.3'/>
        </body></worldbody></mujoco>";
    let mut world = world();
    down(&mut world);
    let ball = RigidBodyBuilder::dynamic().translation(Vector::new(0.0, 0.0, 0.62));
    let (ball, _) = world.insert(ball, ColliderBuilder::ball(0.05).density(1000.0));
    let mut model = join(bowl, &mut world, Pose::IDENTITY, CouplingOptions::default());
    for _ in 0..1000 {
        step(&mut model, &mut world);
    }
    let settled = world.bodies[ball].translation();
    for _ in 0..2000 {
        step(&mut model, &mut world);
    }
    let drift = (world.bodies[ball].translation() - settled).length();
    let weight = world.bodies[ball].mass() * 9.81;
    let force = model.coupling().impulse_on(ball)[0].z / 0.005;
    assert!(drift < 1e-4, "drift of {drift} m in 10 s");
    assert!((force / weight - 1.0).abs() < 0.01, "{force} N of {weight} N");
}

/// The height, after two seconds, of a ball of the model that falls on the world's collider at the origin.
fn rest_on(shape: ColliderBuilder, y_up: bool) -> f64 {
    let ball = "<mujoco><option timestep='.005'/><worldbody><body pos='.02 .03 .3'><freejoint/><geom size='.05' condim='6' friction='1 .1 .1'/></body>
        </worldbody></mujoco>";
    let mut world = world();
    let half = 0.5_f64.sqrt();
    let frame = if y_up {
        Rotation::from_xyzw(-half, 0.0, 0.0, half)
    } else {
        Rotation::IDENTITY
    };
    world.gravity = frame * Vector::new(0.0, 0.0, -9.81);
    world.insert_collider(shape, None);
    let mut ball = join(
        ball,
        &mut world,
        Pose::from_rotation(frame),
        CouplingOptions {
            fixed: 40,
            ..CouplingOptions::default()
        },
    );
    for _ in 0..400 {
        step(&mut ball, &mut world);
    }
    let normal: f64 = ball.state.contact.iter().map(|c| c.world_force()[2].abs()).sum();
    let weight = ball.model().body_mass[1] * 9.81;
    assert!((normal / weight - 1.0).abs() < 0.01, "{normal} N of {weight} N");
    ball.state.qpos[2]
}

#[test]
fn fixed_shapes_carry_the_model() {
    let pillar = |r: f64, h: f64| {
        (0..8).flat_map(move |k| {
            let at = f64::from(k) * 0.25 * std::f64::consts::PI;
            [-h, h].map(|z| Vector::new(r * at.cos(), r * at.sin(), z))
        })
    };
    let hull: Vec<Vector> = pillar(0.4, 0.1).collect();
    let square = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]].map(|[x, y]| Vector::new(x, y, 0.1));
    let grid: Vec<Vector> = (0..25)
        .map(|k| Vector::new(f64::from(k % 5) * 0.2 - 0.4, f64::from(k / 5) * 0.2 - 0.4, 0.1))
        .collect();
    let cells = (0..16_u32).flat_map(|k| {
        let corner = k / 4 * 5 + k % 4;
        [[corner, corner + 1, corner + 6], [corner, corner + 6, corner + 5]]
    });
    let half = 0.5_f64.sqrt();
    let upright = Rotation::from_xyzw(half, 0.0, 0.0, half);
    let shapes = [
        (
            "half space",
            ColliderBuilder::new(SharedShape::halfspace(Vector::Z)).translation(Vector::new(0.0, 0.0, 0.1)),
        ),
        ("cuboid", ColliderBuilder::cuboid(0.3, 0.3, 0.1)),
        (
            "cylinder",
            ColliderBuilder::cylinder(0.1, 0.4).rotation(Vector::new(std::f64::consts::FRAC_PI_2, 0.0, 0.0)),
        ),
        ("hull", ColliderBuilder::convex_hull(&hull).expect("a hull")),
        (
            "compound",
            ColliderBuilder::compound(vec![(
                Pose::from_translation(Vector::new(0.0, 0.0, 0.05)),
                SharedShape::cuboid(0.4, 0.4, 0.05),
            )]),
        ),
        (
            "two triangles",
            ColliderBuilder::trimesh(square.to_vec(), vec![[0, 1, 2], [0, 2, 3]]).expect("a mesh"),
        ),
        (
            "triangles",
            ColliderBuilder::trimesh(grid, cells.collect()).expect("a mesh"),
        ),
        (
            "height field",
            ColliderBuilder::heightfield(Array2::repeat(5, 7, 0.1), Vector::ONE).position(Pose::from_rotation(upright)),
        ),
    ];
    for (name, shape) in shapes {
        let height = rest_on(shape, false);
        assert!((height - 0.15).abs() < 1e-3, "{name}: {height} m");
    }
    let ground = ColliderBuilder::new(SharedShape::halfspace(Vector::Y)).translation(Vector::new(0.0, 0.1, 0.0));
    let height = rest_on(ground, true);
    assert!((height - 0.15).abs() < 1e-3, "y up: {height} m");
}

#[test]
fn a_height_field_has_the_heights_of_the_world() {
    let slope = |i: usize, k: usize| 0.1 + 0.03 * i as f64 + 0.05 * k as f64;
    let field = Array2::new(5, 5, (0..25).map(|n| slope(n % 5, n / 5)).collect::<Vec<_>>());
    let half = 0.5_f64.sqrt();
    let at = Pose::from_rotation(Rotation::from_xyzw(half, 0.0, 0.0, half));
    let mut world = world();
    let collider = world.insert_collider(
        ColliderBuilder::heightfield(field, Vector::new(2.0, 1.0, 2.0)).position(at),
        None,
    );
    let probe = "<mujoco><option timestep='.005'/><worldbody><body pos='0 0 .5'><freejoint/><geom size='.3'/></body></worldbody></mujoco>";
    let mut probe = join(probe, &mut world, Pose::IDENTITY, CouplingOptions::default());
    for [x, y] in [[0.0, 0.0], [0.31, 0.13], [-0.42, 0.27], [0.11, -0.39]] {
        probe.state.qpos[..3].copy_from_slice(&[x, y, 0.5]);
        probe.state.qvel.fill(0.0);
        probe.step(&mut WorldSets::from(&mut world)).expect("a step");
        let down = Ray::new(Vector::new(x, y, 2.0), -Vector::Z);
        let collider = &world.colliders[collider];
        let hit = collider
            .shape()
            .cast_ray(collider.position(), &down, 9.0, false)
            .expect("a hit");
        let below = mjcf_sim_physics::ray(probe.model(), &probe.state, [x, y, 2.0], [0.0, 0.0, -1.0], Some(1));
        let below = below.expect("a state of the model").expect("a hit");
        assert!(
            (below.distance - hit).abs() < 1e-6,
            "at {x} {y}: {} and {hit}",
            below.distance
        );
    }
}

/// A hammer of the model on a slide along x, at 1 m/s.
const HAMMER: &str =
    "<mujoco><option timestep='.005'/><worldbody><body name='hammer' pos='-.5 0 .1'><joint type='slide' axis='1 0 0'/>
    <geom type='box' size='.05 .05 .05' mass='5'/></body></worldbody></mujoco>";

#[test]
fn sleepers_wake_when_they_are_touched_and_not_before() {
    let mut world = world();
    down(&mut world);
    world.insert_collider(
        ColliderBuilder::cuboid(2.0, 2.0, 0.1).translation(Vector::new(0.0, 0.0, -0.1)),
        None,
    );
    let ball = RigidBodyBuilder::dynamic().translation(Vector::new(0.0, 0.0, 0.1));
    let (ball, _) = world.insert(ball, ColliderBuilder::ball(0.1).density(500.0));
    let mut hammer = join(HAMMER, &mut world, Pose::IDENTITY, CouplingOptions::default());
    let falls = (0..2000).find(|_| {
        step(&mut hammer, &mut world);
        world.bodies[ball].is_sleeping()
    });
    assert!(falls.is_some(), "it falls asleep");
    hammer.state.qvel[0] = 1.0;
    let (mut met, mut fastest) = (None, 0.0_f64);
    for k in 0..200 {
        let asleep = world.bodies[ball].is_sleeping();
        step(&mut hammer, &mut world);
        let touched = hammer.coupling().impulse_on(ball)[0] != Vector::ZERO;
        // Rapier itself wakes what a kinematic body comes as near to as it predicts contacts, 2 cm
        let gap = -0.1 - (hammer.state.qpos[0] - 0.45);
        assert!(
            asleep || met.is_some() || gap < 0.03,
            "it sleeps until it is touched, in step {k}"
        );
        if touched {
            met.get_or_insert(k);
            fastest = fastest.max(world.bodies[ball].linvel().x);
            assert!(!world.bodies[ball].is_sleeping(), "it wakes when it is touched");
        }
    }
    assert!(met.is_some_and(|k| k > 40), "touched at {met:?}");
    assert!(fastest > 0.3, "{fastest} m/s");
}

#[test]
fn kinematic_bodies_push_and_are_not_pushed() {
    let mut world = world();
    let wall = RigidBodyBuilder::kinematic_velocity_based()
        .translation(Vector::new(0.3, 0.0, 0.1))
        .linvel(Vector::new(-0.5, 0.0, 0.0));
    let (wall, _) = world.insert(wall, ColliderBuilder::cuboid(0.1, 0.5, 0.5));
    let mut hammer = join(HAMMER, &mut world, Pose::IDENTITY, CouplingOptions::default());
    for _ in 0..400 {
        step(&mut hammer, &mut world);
    }
    let ahead = hammer.state.qpos[0] - 0.5 + 0.05 - (world.bodies[wall].translation().x - 0.1);
    assert!((world.bodies[wall].translation().x - (0.3 - 1.0)).abs() < 1e-9);
    assert!(hammer.state.qvel[0] <= -0.499, "pushed at {} m/s", hammer.state.qvel[0]);
    assert!(ahead < 2e-3, "{ahead} m inside");
}

#[test]
fn impulses_travel_through_joints_of_the_world() {
    let mut world = world();
    let body = |x: f64| RigidBodyBuilder::dynamic().translation(Vector::new(x, 0.0, 0.1));
    let (first, _) = world.insert(body(0.0), ColliderBuilder::cuboid(0.05, 0.05, 0.05).density(1000.0));
    let (second, _) = world.insert(body(0.5), ColliderBuilder::ball(0.05).density(1000.0));
    let joint = FixedJointBuilder::new().local_anchor1(Vector::new(0.5, 0.0, 0.0));
    world.insert_impulse_joint(first, second, joint);
    let mut hammer = join(HAMMER, &mut world, Pose::IDENTITY, CouplingOptions::default());
    hammer.state.qvel[0] = 1.0;
    for _ in 0..200 {
        step(&mut hammer, &mut world);
    }
    let [one, other] = [first, second].map(|b| world.bodies[b].linvel().x);
    assert!(one > 0.5 && (one - other).abs() < 0.01, "{one} and {other} m/s");
    let total = 5.0 * hammer.state.qvel[0]
        + [first, second]
            .map(|b| world.bodies[b].mass() * world.bodies[b].linvel().x)
            .iter()
            .sum::<f64>();
    assert!((total - 5.0).abs() < 1e-6, "{total} N s");
}

#[test]
fn compounds_and_what_changes_between_steps() {
    let mut world = world();
    let body = RigidBodyBuilder::dynamic().translation(Vector::new(0.0, 0.0, 0.1));
    let body = world.insert_body(body);
    for y in [-0.1, 0.1] {
        world.insert_collider(
            ColliderBuilder::ball(0.05)
                .translation(Vector::new(0.0, y, 0.0))
                .density(800.0),
            Some(body),
        );
    }
    let extra = world.insert_collider(ColliderBuilder::cuboid(0.02, 0.1, 0.02).density(800.0), Some(body));
    let mut hammer = join(
        HAMMER,
        &mut world,
        Pose::IDENTITY,
        CouplingOptions {
            near: 1.0,
            ..CouplingOptions::default()
        },
    );
    hammer.state.qvel[0] = 1.0;
    let drawn = |hammer: &CoupledSimulation| hammer.model().geom_group.iter().filter(|&&group| group == 0).count();
    step(&mut hammer, &mut world);
    assert_eq!(drawn(&hammer), 4);
    assert_eq!(hammer.coupling().neighbors().collect::<Vec<_>>(), [body]);
    world.remove_collider(extra);
    world
        .colliders
        .get_mut(world.bodies[body].colliders()[0])
        .expect("a collider")
        .set_shape(SharedShape::ball(0.07));
    step(&mut hammer, &mut world);
    assert_eq!(drawn(&hammer), 3);
    assert!(hammer.model().geom_size.iter().any(|size| size[0] == 0.07));
    for _ in 0..150 {
        step(&mut hammer, &mut world);
    }
    assert!(world.bodies[body].linvel().x > 0.5);
    world.remove_body(body);
    step(&mut hammer, &mut world);
    assert_eq!((drawn(&hammer), hammer.coupling().neighbors().count()), (1, 0));
}

#[test]
fn copies_and_snapshots_of_both_sides_go_on_with_the_same_bits() {
    let mut world = world();
    down(&mut world);
    world.insert_collider(
        ColliderBuilder::cuboid(2.0, 2.0, 0.1).translation(Vector::new(0.0, 0.0, -0.1)),
        None,
    );
    let mut balls = Vec::new();
    for k in 0..3 {
        let ball = RigidBodyBuilder::dynamic().translation(Vector::new(
            0.1 * f64::from(k),
            0.01 * f64::from(k),
            0.1 + 0.25 * f64::from(k),
        ));
        balls.push(world.insert(ball, ColliderBuilder::ball(0.08).density(500.0)).0);
    }
    let mut hammer = join(HAMMER, &mut world, Pose::IDENTITY, CouplingOptions::default());
    let fresh = hammer.clone();
    hammer.state.qvel[0] = 1.5;
    for _ in 0..90 {
        step(&mut hammer, &mut world);
    }
    assert!(hammer.coupling().neighbors().count() > 0);
    let (mut copy, mut world_copy) = (hammer.clone(), copy_of(&world));
    let bytes = hammer.coupling().snapshot().to_bytes();
    let (mut other, mut other_world) = (fresh, copy_of(&world));
    other.state.copy_dynamic_from(&hammer.state);
    let snapshot = CouplingSnapshot::from_bytes(&bytes).expect("a snapshot");
    let model = other.model().clone();
    other
        .coupling_mut()
        .restore(&snapshot, &model, &WorldSets::from(&mut other_world))
        .expect("it fits");
    for _ in 0..100 {
        step(&mut hammer, &mut world);
        step(&mut copy, &mut world_copy);
        step(&mut other, &mut other_world);
    }
    let expected: Vec<_> = balls.iter().map(|&ball| *world.bodies[ball].position()).collect();
    for (sim, world) in [(&copy, &world_copy), (&other, &other_world)] {
        assert_eq!(
            (&sim.state.qpos, &sim.state.qvel),
            (&hammer.state.qpos, &hammer.state.qvel)
        );
        let found: Vec<_> = balls.iter().map(|&ball| *world.bodies[ball].position()).collect();
        assert_eq!(found, expected);
    }
    for end in 0..bytes.len() {
        assert!(CouplingSnapshot::from_bytes(&bytes[..end]).is_err(), "{end} bytes");
    }
}

#[test]
fn queries_find_the_model() {
    let mut world = world();
    let mut hammer = join(HAMMER, &mut world, Pose::IDENTITY, CouplingOptions::default());
    step(&mut hammer, &mut world);
    let down = Ray::new(Vector::new(-0.5, 0.0, 2.0), -Vector::Z);
    let queries = world.broad_phase.as_query_pipeline(
        world.narrow_phase.query_dispatcher(),
        &world.bodies,
        &world.colliders,
        QueryFilter::default(),
    );
    let (collider, distance) = queries.cast_ray(&down, 9.0, true).expect("a hit");
    assert!((distance - 1.85).abs() < 1e-12);
    let geom = hammer.coupling().geom_of(collider).expect("a geom");
    assert_eq!(
        (hammer.model().geom_bodyid[geom], hammer.coupling().collider_of(geom)),
        (1, Some(collider))
    );
    hammer.leave(&mut WorldSets::from(&mut world));
    assert_eq!((world.bodies.len(), world.colliders.len()), (0, 0));
}

#[test]
fn what_cannot_be_coupled_is_an_error() {
    let fails = |change: &dyn Fn(&mut PhysicsWorld), options: CouplingOptions, says: &str| {
        let mut world = world();
        let mut hammer = join(HAMMER, &mut world, Pose::IDENTITY, options);
        change(&mut world);
        let error = hammer
            .step(&mut WorldSets::from(&mut world))
            .expect_err(says)
            .to_string();
        assert!(error.contains(says), "{error}");
    };
    let here = Vector::new(-0.5, 0.0, 0.1);
    let options = CouplingOptions {
        bodies: 1,
        compounds: 0,
        ..CouplingOptions::default()
    };
    let two = |world: &mut PhysicsWorld| {
        for _ in 0..2 {
            world.insert(
                RigidBodyBuilder::dynamic().translation(here),
                ColliderBuilder::ball(0.1),
            );
        }
    };
    fails(&two, options, "more than 1 bodies");
    let voxels = |world: &mut PhysicsWorld| {
        let voxels = ColliderBuilder::voxels(Vector::splat(0.1), &[IVector::ZERO]).translation(here);
        world.insert_collider(voxels, None);
    };
    fails(&voxels, CouplingOptions::default(), "made of voxels");
    let slow = |world: &mut PhysicsWorld| world.integration_parameters.dt = 0.007;
    fails(&slow, CouplingOptions::default(), "0.007 s, is not 1 time steps");
    let model = mjcf_sim::Simulation::from_text(HAMMER)
        .expect("a model")
        .model()
        .clone();
    let error = CoupledSimulation::insert(
        model,
        &mut WorldSets::from(&mut world()),
        Pose::IDENTITY,
        CouplingOptions::default(),
    );
    assert!(matches!(error, Err(CouplingError::NoSlots { .. })));
}

#[test]
fn groups_keep_bodies_away() {
    let mut world = world();
    let apart = InteractionGroups::new(Group::GROUP_2, Group::GROUP_2, InteractionTestMode::And);
    let body = RigidBodyBuilder::dynamic().translation(Vector::new(0.0, 0.0, 0.1));
    let (body, _) = world.insert(body, ColliderBuilder::ball(0.1).collision_groups(apart));
    let mine = InteractionGroups::new(Group::GROUP_1, Group::GROUP_1, InteractionTestMode::And);
    let mut hammer = join(
        HAMMER,
        &mut world,
        Pose::IDENTITY,
        CouplingOptions {
            groups: mine,
            ..CouplingOptions::default()
        },
    );
    hammer.state.qvel[0] = 1.0;
    for _ in 0..300 {
        step(&mut hammer, &mut world);
    }
    assert_eq!((hammer.state.qvel[0], world.bodies[body].linvel().x), (1.0, 0.0));
}
