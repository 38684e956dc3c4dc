// SPDX-License-Identifier: Apache-2.0
// The words of the scene language that stand for enumerators: one table an enum, read both ways by the grammar, the
// parser and the writers. Public names: never rename.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "renderer/scene/scene.h"

namespace tilelight {

template <class Enum>
struct NamedValue {
  Enum value;
  std::string_view name;
};

inline constexpr std::array<NamedValue<LightKind>, 2> kLightKinds{
    {{LightKind::point, "point"}, {LightKind::directional, "directional"}}};
inline constexpr std::array<NamedValue<AttenuationMode>, 3> kAttenuationModes{
    {{AttenuationMode::linear, "linear"},
     {AttenuationMode::inverse_square, "inverse_square"},
     {AttenuationMode::none, "none"}}};
inline constexpr std::array<NamedValue<Piece>, kPieceKinds> kPieces{{{Piece::pawn, "pawn"},
                                                                     {Piece::rook, "rook"},
                                                                     {Piece::knight, "knight"},
                                                                     {Piece::bishop, "bishop"},
                                                                     {Piece::queen, "queen"},
                                                                     {Piece::king, "king"}}};
inline constexpr std::array<NamedValue<Side>, 2> kSides{{{Side::white, "white"}, {Side::black, "black"}}};
inline constexpr std::array<NamedValue<ChessRole>, kChessRoles> kChessRoleNames{{{ChessRole::white, "white"},
                                                                                 {ChessRole::black, "black"},
                                                                                 {ChessRole::light, "light"},
                                                                                 {ChessRole::dark, "dark"},
                                                                                 {ChessRole::frame, "frame"}}};
inline constexpr std::array<NamedValue<Projection>, 2> kProjections{
    {{Projection::perspective, "perspective"}, {Projection::orthographic, "orthographic"}}};
inline constexpr std::array<NamedValue<Algorithm>, 4> kAlgorithms{{{Algorithm::raytrace, "raytrace"},
                                                                   {Algorithm::zbuffer, "zbuffer"},
                                                                   {Algorithm::warnock, "warnock"},
                                                                   {Algorithm::roberts, "roberts"}}};
inline constexpr std::array<NamedValue<Shading>, 3> kShadings{
    {{Shading::flat, "flat"}, {Shading::gouraud, "gouraud"}, {Shading::phong, "phong"}}};
inline constexpr std::array<NamedValue<PixelFilter>, 3> kFilters{
    {{PixelFilter::box, "box"}, {PixelFilter::tent, "tent"}, {PixelFilter::gaussian, "gaussian"}}};
inline constexpr std::array<NamedValue<Terminator>, 2> kTerminators{
    {{Terminator::smooth, "smooth"}, {Terminator::exact, "exact"}}};

template <class Enum, size_t n>
constexpr std::optional<Enum> find_word(const std::array<NamedValue<Enum>, n>& table, std::string_view name) {
  for (const auto& entry : table) {
    if (entry.name == name) return entry.value;
  }
  return std::nullopt;
}

template <class Enum, size_t n>
constexpr std::string_view get_word(const std::array<NamedValue<Enum>, n>& table, Enum value) {
  for (const auto& entry : table) {
    if (entry.value == value) return entry.name;
  }
  return {};
}

}  // namespace tilelight
