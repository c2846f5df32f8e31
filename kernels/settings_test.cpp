#include "kernels/settings.h"

#include "kernels/testing/complaint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <stdexcept>

namespace boxwood {
namespace {

using testing::HasSubstr;

enum class Colour { red, green };

struct Painted {
    static constexpr std::string_view name = "painted";

    int coats = 2;
    double gloss = .5;
    bool dry = false;
    Colour colour = Colour::green;

    static auto settings() {
        return std::array{
            Setting<Painted>("coats", "layers of paint", &Painted::coats, 1, 9),
            Setting<Painted>("gloss", "share of light", &Painted::gloss, 0, 1),
            Setting<Painted>("dry", "whether it is", &Painted::dry),
            Setting<Painted>("colour", "of the paint", &Painted::colour, {"red", "green"})};
    }
};
struct Plain {
    static constexpr std::string_view name = "plain";
};

template <class T = Painted> std::string complaint(const Settings& settings) {
    return complaint_of([&] { with_settings<T>(settings); });
}

TEST(Settings, ReachMembersOfEveryType) {
    const Painted made =
        with_settings<Painted>({{"coats", 3}, {"gloss", .25}, {"dry", true}, {"colour", "red"}});
    EXPECT_EQ(made.coats, 3);
    EXPECT_EQ(made.gloss, .25);
    EXPECT_TRUE(made.dry);
    EXPECT_EQ(made.colour, Colour::red);
    EXPECT_EQ(with_settings<Painted>({{"gloss", 1}}).gloss, 1) << "a whole number is a number";
}

TEST(Settings, AreListedWithTypesDefaultsAndWhatIsAllowed) {
    const auto infos = setting_infos<Painted>();
    ASSERT_EQ(infos.size(), 4u);
    EXPECT_EQ(infos[0].default_value, SettingValue(2));
    EXPECT_EQ(infos[1].default_value, SettingValue(.5));
    EXPECT_EQ(infos[2].default_value, SettingValue(false));
    EXPECT_EQ(infos[3].default_value, SettingValue("green"));
    EXPECT_EQ(allowed_values(infos[0]), "1 to 9");
    EXPECT_EQ(allowed_values(infos[1]), "0 to 1");
    EXPECT_EQ(allowed_values(infos[2]), "true or false");
    EXPECT_EQ(allowed_values(infos[3]), "red or green");
    EXPECT_TRUE(setting_infos<Plain>().empty());
}

TEST(Settings, RefuseOtherTypesRangesAndNamesWithAReason) {
    EXPECT_EQ(complaint({{"coats", 10}}),
              "setting 'coats' of 'painted' must be a whole number from 1 to 9, not 10");
    EXPECT_EQ(complaint({{"coats", 1.5}}),
              "setting 'coats' of 'painted' must be a whole number from 1 to 9, not 1.5");
    EXPECT_EQ(complaint({{"coats", true}}),
              "setting 'coats' of 'painted' must be a whole number from 1 to 9, not true");
    EXPECT_EQ(complaint({{"gloss", "high"}}),
              "setting 'gloss' of 'painted' must be a number from 0 to 1, not high");
    EXPECT_THAT(complaint({{"gloss", std::numeric_limits<double>::quiet_NaN()}}),
                HasSubstr("must be a number from 0 to 1"));
    EXPECT_EQ(complaint({{"dry", 1}}), "setting 'dry' of 'painted' must be true or false, not 1");
    EXPECT_EQ(complaint({{"colour", "blue"}}),
              "setting 'colour' of 'painted' must be red or green, not blue");
    EXPECT_EQ(complaint({{"coast", 2}}), "'painted' has no setting 'coast'; it has coats, gloss, "
                                         "dry, colour; did you mean 'coats'?");
    EXPECT_EQ(complaint<Plain>({{"coats", 2}}), "'plain' has no setting 'coats'; it has none");
}

TEST(Settings, HaveShortTexts) {
    EXPECT_EQ(to_text(16), "16");
    EXPECT_EQ(to_text(.5), "0.5");
    EXPECT_EQ(to_text(1e6), "1000000");
    EXPECT_EQ(to_text(2e300), "2e+300");
    EXPECT_EQ(to_text(true), "true");
    EXPECT_EQ(to_text("red"), "red");
}

} // namespace
} // namespace boxwood
