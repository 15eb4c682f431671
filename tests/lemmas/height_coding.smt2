; SPDX-License-Identifier: MIT
; Prediction of heights from weighted sums over a ring, whose weights add up to `weight`.

; The mean's dividend is positive and fits 32 bits, and so do the sums and what is made of them.
;; shared/height_coding.hpp: static_cast<uint32_t>(2 * sums.heights) + sums.weights + (divisor << 16);
(push)
(declare-const weight Int)
(declare-const height Int)
(declare-const spread Int)
(assert (<= 32 weight 15904))
(assert (<= (* -65535 weight) height (* 65535 weight)))  ; of differences of heights
(assert (<= 0 spread (* 65535 weight)))
(define-fun dividend () Int (+ (* 2 height) weight (* 131072 weight)))
(check-sat)
(assert (not (and (<= 0 dividend) (< dividend 4294967296) (< (- 2147483648) (* 2 height) 2147483648)
                  (< (+ (* 4 spread) weight) 4294967296))))
(check-sat)
(pop)

; A prediction lies between the lowest and the highest height of the ring, `low` .. `high` above the base. So a
; difference from it is below 2^17.
;; shared/height_coding.hpp: const uint32_t mean = dividend / divisor;
;; shared/height_coding.hpp: constexpr uint32_t kMagnitudeBits = 17;  // a difference of heights is below 2^17
(push)
(declare-const weight Int)
(declare-const height Int)
(declare-const low Int)
(declare-const high Int)
(declare-const mean Int)
(declare-const lost Int)
(assert (and (<= 32 weight 15904) (<= (- 65535) low) (<= low high) (<= high 65535)))
(assert (<= (* low weight) height (* high weight)))
(assert (and (= (+ (* 2 height) weight) (+ (* 2 weight mean) lost)) (<= 0 lost) (< lost (* 2 weight))))
(check-sat)
(assert (not (<= low mean high)))
(check-sat)
(pop)
