#include "povray/sdl_text.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <stdexcept>
#include <string>

namespace skinglow::detail {
namespace {

TEST(SdlText, IdentifiersAreSafeAndDifferent) {
    EXPECT_EQ(sdl_identifier("Mesh", "u"), "Skinglow_Mesh_u");
    EXPECT_EQ(sdl_identifier("Mesh", "a b"), "Skinglow_Mesh_a_20_b");
    std::set<std::string> identifiers;
    for (const std::string name : {"", "_", "__", "a b", "a_b", "a_20_b", "\xc3\xa9"}) {
        identifiers.insert(sdl_identifier("Mesh", name));
    }
    identifiers.insert(sdl_identifier("Mesh", std::string(1000, 'a')));
    identifiers.insert(sdl_identifier("Mesh", std::string(1001, 'a')));
    EXPECT_EQ(identifiers.size(), 9U);
    for (const std::string& identifier : identifiers) {
        EXPECT_LT(identifier.size(), 150U);
        EXPECT_EQ(
            identifier.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_"),
            std::string::npos);
    }
}

TEST(SdlText, StringsAndCommentsCannotBreakOut) {
    EXPECT_EQ(sdl_string("name", "a\"b\\"), "\"a\\\"b\\\\\"");
    EXPECT_THROW(sdl_string("name", "a\nb"), std::invalid_argument);
    EXPECT_EQ(sdl_comment("a\n#error \xc3\xa9\\"), "a?#error ???");
}

TEST(SdlText, NumbersReadBackAsTheSame) {
    SdlText text;
    EXPECT_THROW(text.add(std::numeric_limits<double>::infinity()), std::invalid_argument);
    EXPECT_THROW(text.add(std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
    text.add(0.1 + 0.2).add(" ").add(-0.0).add(" ").add(1e-310).add(" ").add(glm::dvec3(1, 2.5, -3));
    EXPECT_EQ(text.take(), "0.30000000000000004 0 1e-310 <1,2.5,-3>");
}

}  // namespace
}  // namespace skinglow::detail
