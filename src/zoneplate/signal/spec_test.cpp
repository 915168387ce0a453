#include "zoneplate/signal/spec.h"

#include <gtest/gtest.h>

#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

std::string complaint(std::string_view text) {
  try {
    settle(parse_spec(text), {{"sigma", "width", 1, 0.1, 100}, {"radius", "reach", 4, 1, 8}});
  } catch (const Error& e) {
    EXPECT_EQ(e.trouble(), ErrorKind::Usage);
    return e.what();
  }
  return "";
}

TEST(Spec, ReadsNameAndValuesAndFillsInDefaults) {
  const Spec spec = parse_spec("gaussian:radius=6,sigma=2.5");
  EXPECT_EQ(spec.name, "gaussian");
  EXPECT_EQ(settle(spec, {{"sigma", "", 1, 0, 9}, {"radius", "", 4, 0, 9}, {"x", "", 7, 0, 9}}),
            (std::vector<double>{2.5, 6, 7}));
  EXPECT_EQ(text_of(spec), "gaussian:radius=6,sigma=2.5");
  EXPECT_EQ(text_of(parse_spec("box")), "box");
}

TEST(Spec, RefusesWhatItDoesNotUnderstandAndSaysWhatItWants) {
  EXPECT_EQ(complaint("g:sigma=2"), "");
  EXPECT_EQ(complaint(""), "'': wants a name, as in gaussian:sigma=2");
  EXPECT_EQ(complaint("g:"), "'g:': nothing follows the colon, wants name=value");
  EXPECT_EQ(complaint("g:2"), "'g:2': found '2', wants name=value");
  EXPECT_EQ(complaint("g:sigma=2x"), "'g:sigma=2x': sigma is '2x', wants a number");
  EXPECT_EQ(complaint("g:sigma=nan"), "'g:sigma=nan': sigma is 'nan', wants a number");
  EXPECT_EQ(complaint("g:sigma=1,sigma=2"), "'g:sigma=1,sigma=2': sigma is given twice");
  EXPECT_EQ(complaint("g:lobes=3"), "g: no parameter 'lobes'; wants sigma, radius");
  EXPECT_EQ(complaint("g:sigma=0"), "g: sigma is 0, wants 0.1 to 100");
}

}  // namespace
}  // namespace zoneplate
