// SPDX-License-Identifier: Apache-2.0
// PovText: text in POV-Ray's scene language, put together from numbers, vectors, colours and matrices.
#pragma once

#include <cstdarg>
#include <cstdio>
#include <string>

#include "renderer/base/vec.h"

namespace tilelight {

class PovText {
 public:
  // A part is at most 511 characters.
  __attribute__((format(printf, 2, 3))) void add(const char* format, ...) {
    char part[512];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(part, sizeof part, format, arguments);
    va_end(arguments);
    text_ += part;
  }
  void add(const std::string& text) { text_ += text; }
  void vector(const Vec3& v) { add("<%.12g,%.12g,%.12g>", v.x, v.y, v.z); }
  void color(const Color& c) { add("rgb <%.9g,%.9g,%.9g>", c.r, c.g, c.b); }
  // Of an affine map; nothing for the identity.
  void matrix(const Mat4& m) {
    if (m == Mat4(1.0)) return;
    add(" matrix <");
    for (int column = 0; column < 4; ++column) {
      const Vec4& c = m[column];
      add("%s%.12g,%.12g,%.12g", column ? ", " : "", c.x, c.y, c.z);
    }
    add(">");
  }

  const std::string& str() const { return text_; }

 private:
  std::string text_;
};

}  // namespace tilelight
