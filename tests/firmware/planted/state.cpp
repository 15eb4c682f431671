// Must be rejected by tests/symbols.cmake: global state.
extern "C" int planted() {
  static int calls;
  return ++calls;
}
