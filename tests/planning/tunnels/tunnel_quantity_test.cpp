// What is known of a tunnel, in words and back.
#include "planning/tunnels/tunnel_quantity.h"

#include <gtest/gtest.h>

namespace arthronaut::tunnels {
namespace {

using enum Quantity;

TEST(TunnelQuantity, EachNameIsReadBack) {
  for (const Quantity quantity : all_quantities()) EXPECT_EQ(quantity_from_text(to_text(quantity)), quantity);
  EXPECT_EQ(quantity_from_text("wall"), std::nullopt);
}

// What is not known is named beside what is; of all or nothing there is nothing to say.
TEST(TunnelQuantity, SaysWhatIsKnownAndWhatIsNot) {
  EXPECT_EQ(known_in_words({Entry, Direction}), "entry and direction; not the diameter and length");
  EXPECT_EQ(known_in_words({Entry, Direction, Length}), "entry, direction and length; not the diameter");
  EXPECT_EQ(known_in_words({}), "");
  EXPECT_EQ(known_in_words(all_quantities()), "");
}

}  // namespace
}  // namespace arthronaut::tunnels
