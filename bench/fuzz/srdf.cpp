/// SRDF files of a robot of three links: refused with the file's name, or written and read the
/// same.

#include "scenes/robots/srdf.h"
#include "bench/fuzz/fuzz.h"

namespace boxwood::fuzz {

void srdf(Bytes bytes) {
    RobotDescription robot{"robot", {{"a"}, {"b"}, {"c"}}};
    robot.joints = {{"i", JointKind::fixed, 0, 1}, {"j", JointKind::continuous, 1, 2}};
    Srdf found;
    try {
        found = parse_srdf(text_of(bytes), "fuzz.srdf", robot);
    } catch (const std::runtime_error& error) {
        require(std::string_view(error.what()).starts_with("fuzz.srdf:"),
                std::string("an error without the file's name: ") + error.what());
        return;
    }
    const Srdf plain = parse_srdf(srdf_text(robot, found.allowed), "fuzz.srdf", robot);
    const Srdf kept =
        parse_srdf(srdf_text(robot, found.allowed, text_of(bytes)), "fuzz.srdf", robot);
    require(plain.allowed == found.allowed && kept.allowed == found.allowed,
            "what is written reads otherwise");
    require(kept.states.size() == found.states.size(), "states are lost");
}

} // namespace boxwood::fuzz
