/// OBJ files.

#include "bench/fuzz/mesh.h"

namespace boxwood::fuzz {

void mesh_obj(Bytes bytes) {
    static const ScratchFile file(".obj");
    read_mesh(file, bytes);
}

} // namespace boxwood::fuzz
