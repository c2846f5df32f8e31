#include "kernels/kinematics/robot_description.h"

namespace boxwood {

std::string_view name_of(JointKind kind) {
    switch (kind) {
    case JointKind::fixed:
        return "fixed";
    case JointKind::revolute:
        return "revolute";
    case JointKind::continuous:
        return "continuous";
    case JointKind::prismatic:
        break;
    }
    return "prismatic";
}

std::string_view name_of(AllowedReason reason) {
    switch (reason) {
    case AllowedReason::adjacent:
        return "adjacent";
    case AllowedReason::never:
        return "never";
    case AllowedReason::always:
        return "always";
    case AllowedReason::default_state:
        return "default";
    case AllowedReason::sampled:
        return "sampled";
    case AllowedReason::user:
        break;
    }
    return "user";
}

} // namespace boxwood
