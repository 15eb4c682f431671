; Prediction of heights from weighted sums over a ring.

; The mean's dividend is positive and fits 32 bits; `scale` is 2^shift, `weight` what is left of the weights.
;; shared/height_coding.hpp: const uint32_t dividend = static_cast<uint32_t>(2 * heights) + weights + (divisor << 17);
(push)
(declare-const weights Int)
(declare-const sum Int)
(declare-const scale Int)
(declare-const weight Int)
(declare-const lost Int)
(declare-const height Int)
(declare-const lost_height Int)
(assert (and (<= 1 scale) (<= 1 weight 8191)))
(assert (and (= weights (+ (* weight scale) lost)) (<= 0 lost) (< lost scale)))
(assert (<= (* -65535 weights) sum (* 65535 weights)))  ; of differences of heights
(assert (and (= sum (+ (* height scale) lost_height)) (<= 0 lost_height) (< lost_height scale)))
(define-fun dividend () Int (+ (* 2 height) weight (* 262144 weight)))
(check-sat)
(assert (not (and (<= 0 dividend) (< dividend 4294967296) (< (- 1073741824) height 1073741824))))
(check-sat)
(pop)

; A prediction is next to the heights of the ring, `low` .. `high` above the base: beyond them by 17 at most, since
; the weights keep 12 bits behind the leading one. So a difference from it is below 2^17.
;; shared/height_coding.hpp: const uint32_t mean = dividend / divisor;
;; shared/height_coding.hpp: constexpr uint32_t kMagnitudeBits = 17;  // a difference of heights is below 2^17
(push)
(declare-const weight Int)
(declare-const height Int)
(declare-const low Int)
(declare-const high Int)
(declare-const mean Int)
(declare-const lost Int)
(assert (and (<= 4096 weight 8191) (<= (- 65535) low 0) (<= 0 high 65535)))
(assert (and (<= (* low (+ weight 1)) (+ height 1)) (<= height (* high (+ weight 1)))))
(assert (and (= (+ (* 2 height) weight) (+ (* 2 weight mean) lost)) (<= 0 lost) (< lost (* 2 weight))))
(check-sat)
(assert (not (<= (- low 17) mean (+ high 17))))
(check-sat)
(pop)
