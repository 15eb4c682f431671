; SPDX-License-Identifier: MIT
; True, but of nothing: the assumptions contradict each other.
;; decoder/range_decoder.hpp: const uint32_t part = width / count;
(push)
(declare-const count Int)
(assert (and (<= 2 count 65536) (< 65536 count)))
(check-sat)
(assert (not (= count 7)))
(check-sat)
(pop)
