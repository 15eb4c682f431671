; SPDX-License-Identifier: MIT
; True, but of a line that the source does not have.
;; decoder/range_decoder.hpp: range /= count + 1;
(push)
(declare-const count Int)
(check-sat)
(assert (not (< count (+ count 1))))
(check-sat)
(pop)
