; SPDX-License-Identifier: MIT
; False: with a margin of 64 / 2^15 a part of the interval can be narrower than 2^16.
(declare-const range Int)
(assert (and (<= 16777216 range) (< range 4294967296)))
;; decoder/range_decoder.hpp: const uint32_t bound = (range >> 15) * probability;
(push)
(declare-const probability Int)
(assert (<= 64 probability 32704))
(define-fun bound () Int (* (div range 32768) probability))
(check-sat)
(assert (not (<= 65536 bound)))
(check-sat)
(pop)
