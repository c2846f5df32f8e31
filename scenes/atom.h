#pragma once

#include <string>
#include <string_view>

namespace boxwood {

/// Lower-case letters and digits, every run of other characters one underscore, none at the ends;
/// "file" if nothing is left: a part of a scene's name.
std::string atom(std::string_view text);

/// The shortest decimal that reads back as x, without exponent, as a part of a name: "0_5", "10",
/// "m3".
std::string atom(double x);

} // namespace boxwood
