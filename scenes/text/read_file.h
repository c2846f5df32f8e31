#pragma once

#include "scenes/text/bad_input.h"

#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

namespace boxwood {

/// All bytes of a file, which may be a pipe. Throws BadInput for one that is not there, is a folder
/// or cannot be read: "FILE: why", or "KIND FILE: why" of a kind ("URDF").
std::string read_file(const std::filesystem::path& file, std::string_view kind = {});

/// What a stream still holds. Throws BadInput, "name: why".
std::string read_stream(std::FILE* stream, const std::string& name);

} // namespace boxwood
