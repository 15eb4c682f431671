// Must be rejected by tests/symbols.cmake: a static constructor.
extern "C" int planted();

extern const int kPlanted;
const int kPlanted = planted();
