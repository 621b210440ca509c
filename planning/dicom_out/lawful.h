// What was taken over from images, or typed by a person, as DICOM allows it to be written (PS3.5, 6.2): what
// a hospital's own images say is often longer than that, or in another form. Inner header of dicom_out.
#pragma once

#include <string>
#include <vector>

#include "planning/dicom_out/belonging.h"

namespace arthronaut::dicom_out {

// Changes patient and study of `belonging` to what may be written, and says so, one sentence an attribute, in
// words that name nobody:
//
//   StudyID                          cut to its 16 characters: it is for people to read
//   AccessionNumber                  left out where it is longer than 16: a part of it is another order's
//   names of persons                 64 characters and five parts in each of three alphabets
//   dates and times                  in DICOM's form, from "1990-01-31" or "08:15:00" too; left out where
//   they
//                                    are no date, no time of day
//   PatientSex                       F, M or O, in capitals; else left out
//
// What identifies stays as it came, and is told where it breaks the rules: unique identifiers, and PatientID
// with its issuer. The images are filed under these, right or wrong, and anything else is filed elsewhere.
[[nodiscard]] std::vector<std::string> make_lawful(Belonging& belonging);

}  // namespace arthronaut::dicom_out
