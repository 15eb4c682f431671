// SPDX-License-Identifier: MIT
// Must be rejected by callgraph.py: two functions that call each other.
extern "C" int planted_odd(int n, const int* sum);

extern "C" int planted_even(int n, const int* sum) {
  const int more[2] = {n, *sum};
  return n == 0 ? *sum : planted_odd(n - 1, more) + 1;
}

extern "C" int planted_odd(int n, const int* sum) {
  const int more[2] = {n, *sum};
  return n == 0 ? -*sum : planted_even(n - 1, more) + 2;
}
