// DCMTK's own log, which goes to standard error. Inner header of pacs.
#pragma once

namespace arthronaut::pacs {

// What it stumbles over is said by us, once and with the file or the peer. For the whole program.
void silence_dcmtk();

}  // namespace arthronaut::pacs
