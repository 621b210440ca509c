// OpenGL by the processor (Mesa's llvmpipe), where no graphics card draws.
#pragma once

namespace arthronaut::widgets {

// Whether the context that is current draws by the processor.
[[nodiscard]] bool draws_by_processor();

}  // namespace arthronaut::widgets
