#pragma once

#include <string_view>

namespace boxwood::bench {

/// Contenders of the task that plays a scene: with the stages that its queries require, with all,
/// and with the required ones but without one effect, whose name follows.
inline constexpr std::string_view required_variant = "required", all_stages_variant = "all_stages",
                                  without_effect = "required.without_";

} // namespace boxwood::bench
