#pragma once

#include "scenes/meshes/mesh_file.h"

#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace boxwood {

/// What is wrong in a mesh file and where; `load_mesh` puts the file's name before it.
class MeshError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Reads the bytes of a file before assimp does, and throws MeshError for what assimp would repair,
/// repeat or drop silently: coordinates that are no finite float, if they are to be refused, and
/// files that end too soon.
void scan_stl(std::string_view bytes, NotFinite not_finite = NotFinite::refuse);

/// The same for OBJ and PLY, and indices out of range. They return vertices and faces as a plain
/// binary PLY file for assimp to go on with: assimp 5.2.5's own OBJ reader drops vertices such as
/// "v .5 0 0", reads comments behind a statement, sorts by material, and is an ulp off for one
/// float in four; its PLY reader crashes, or never ends, on some headers. Of a vertex only the
/// position is kept. Throw as well if no face has three corners.
std::string scan_obj(std::string_view text, NotFinite not_finite = NotFinite::refuse);
std::string scan_ply(std::string_view bytes, NotFinite not_finite = NotFinite::refuse);

/// What they return.
class PlyMesh {
  public:
    void add_vertex(const std::array<float, 3>& point);
    /// Indices from 0; points and lines are left out.
    void add_face(std::span<const std::int64_t> corners);
    /// Throws MeshError if there is no face.
    std::string bytes() const;

  private:
    std::string vertices_, faces_;
    std::size_t n_faces_ = 0;
};

/// A coordinate from text, rounded to nearest. Throws MeshError, naming the line (counted from 1)
/// and the token, unless it is a decimal number that fits a finite float, or that need not.
float coordinate(std::string_view token, std::size_t line,
                 NotFinite not_finite = NotFinite::refuse);

/// Takes the next token (separated by blanks) off the front; empty at the end.
std::string_view take_token(std::string_view& text);

/// Takes the next line off the front, without its end ("\n" or "\r\n").
std::string_view take_line(std::string_view& text);

} // namespace boxwood
