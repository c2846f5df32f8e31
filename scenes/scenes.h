#pragma once

/// Scenes: (name, n, seed) gives the same bits on every machine. This header holds all that is
/// public.
///
///     Scene scene = make_scene({.generator = "uniform", .n = 100000, .seed = 1});
///     scene.boxes         // what the trees are built of
///     scene.content_hash  // the same on every machine
///
/// A generator draws item i from counter-based random numbers keyed by (seed, stream) and steers
/// its sizes so that a box overlaps spec.overlaps others in the mean. It knows no tree.

#include "kernels/suggest.h"             // "did you mean ...?"
#include "scenes/effects/effect_scene.h" // effects laid on what a generator makes
#include "scenes/human_name.h"           // "100,000 uniform boxes, 10 overlaps each"
#include "scenes/meshes/mesh_file.h"     // the user's mesh through assimp, with what is wrong in it
#include "scenes/moving/frames.h"        // a moving scene's boxes frame by frame, held or streamed
#include "scenes/moving/moving_scene.h"  // bodies and what happens to them, played frame by frame
#include "scenes/robots/four_link.h"     // the demo's robot: forward kinematics and its boxes
#include "scenes/robots/random_values.h" // states of a robot at random, within limits
#include "scenes/robots/robot_scene.h"   // the user's robot in random states, as a scene
#include "scenes/robots/srdf.h"          // allowed pairs and named states, read and written
#include "scenes/robots/urdf.h"          // the user's robot and its meshes through liburdfdom
#include "scenes/sampling/poses.h"       // places of a copy of a mesh beside it
#include "scenes/sampling/queries.h"     // points and regions laid into a scene
#include "scenes/sampling/random.h"      // Philox: item i is independent of n and of order
#include "scenes/sampling/rays.h"        // camera, random, ambient and occlusion rays at a mesh
#include "scenes/sampling/scatter.h"     // boxes that overlap as often as wanted
#include "scenes/scene.h"                // the contract: SceneSpec, Scene, make_scene, registries
