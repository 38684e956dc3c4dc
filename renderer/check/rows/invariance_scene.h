// SPDX-License-Identifier: Apache-2.0
// The study: one realistic scene, and the same scene in other units, elsewhere, turned or mirrored. Pure values.
#pragma once

#include <span>

#include "renderer/check/check.h"
#include "renderer/check/kit/pictures.h"
#include "renderer/check/kit/textbook.h"
#include "renderer/scene/scene.h"

namespace tilelight::check {

// A checkered board on a plane; on it a glossy, a mirroring and a very small sphere, a turned cube, a stretched
// octahedron and a pawn; two point lights and a faint directional one. The background is of one colour: the model
// mixes it by the world's y, which a turn would change. Square, one sample a pixel.
ParsedScene study(int size_px, AttenuationMode attenuation = AttenuationMode::linear);

// The study in a unit of length that is 1/s of the old one: the same picture. What is a length:
//   sphere center, radius; box min, max; plane point; mesh positions; the translation of every transform;
//   the cells of checkers, which are counted in the object's own frame; positions of lights; position and target of the
//   camera and the height of an orthographic one. A chess piece is of fixed size: its transform takes the scale.
// What is none: normals, up, directions, the field of view, colours, shininess, ior.
// Light: 1 / (d + K) falls by s, so K and the intensity of point lights grow by s; 1 / (d^2 + K) takes s^2 for both.
// Directional lights are never attenuated: their intensity stays.
ParsedScene scaled(ParsedScene parsed, double s);

// Everything moved, as its author would write it: an object without a turn or stretch of its own in its coordinates,
// any other in its `translate`.
ParsedScene shifted(ParsedScene parsed, const Vec3& by);

// Everything under a rotation or mirroring about the origin: each object by its transform; lights; the camera's
// position, target and up. REQUIRES: `m` is orthogonal. A mirrored camera keeps its right hand: its picture is flipped.
ParsedScene turned(ParsedScene parsed, const Mat3& m);

// By the textbook's tracer.
TextbookTracer::Picture textbook_picture(const ParsedScene& parsed, TilePool& pool, float epsilon = 1e-3f);

// The rows of invariance_instances.cpp.
std::span<const Row> instance_rows();

}  // namespace tilelight::check
