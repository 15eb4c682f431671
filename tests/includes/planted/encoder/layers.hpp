// SPDX-License-Identifier: MIT
// Lists a layer that is not included: terrain of importing.
namespace microtin {

namespace base {}

namespace exact {
using namespace base;
}

namespace terrain {}

namespace importing {
using namespace terrain;
}

namespace fit {}

namespace pack {}

namespace cli {}

}  // namespace microtin
