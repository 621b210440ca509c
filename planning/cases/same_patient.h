// Whether what two sources say of a patient may be said of one: number, date of birth and name.
#pragma once

#include "planning/cases/identity.h"

namespace arthronaut::cases {

// What one of them does not say is no difference, nor are capitals, blanks, and how a date is written. Where
// both say number and date of birth, these decide: names change, and are written in many ways.
[[nodiscard]] bool is_another_patient(const Identity& a, const Identity& b);

// Whether both say a number, the same one, and nothing that makes them two patients: what is no more than not
// another one may be anybody.
[[nodiscard]] bool is_same_patient(const Identity& a, const Identity& b);

}  // namespace arthronaut::cases
