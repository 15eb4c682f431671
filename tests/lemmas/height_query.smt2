; SPDX-License-Identifier: MIT
; Heights of places within a triangle, and places on the lattice.

; An orientation at a place with 8 fractional bits: factors fit 32 bits, a product 2^40.
;; shared/interpolation.hpp: return static_cast<int64_t>(abx) * (p.y - o.y) - static_cast<int64_t>(aby) * (p.x - o.x);
(push)
(declare-const side Int)
(declare-const place Int)
(declare-const corner Int)
(assert (and (<= (- 65535) side 65535) (<= 0 place 16776960) (<= 0 corner 65535)))
(define-fun offset () Int (- place (* 256 corner)))
(check-sat)
(assert (not (and (< (- 16777216) offset 16777216) (< (- 1099511627776) (* side offset) 1099511627776))))
(check-sat)
(pop)

; The sum of weighted differences is within 2^56.
;; shared/interpolation.hpp: weight_b * (static_cast<int32_t>(b.z) - a.z) + weight_c * (static_cast<int32_t>(c.z) - a.z);
(push)
(declare-const weight_b Int)
(declare-const weight_c Int)
(declare-const b Int)
(declare-const c Int)
(assert (and (<= 0 weight_b) (<= 0 weight_c) (<= (+ weight_b weight_c) 1099511627776)))
(assert (and (<= (- 65535) b 65535) (<= (- 65535) c 65535)))
(check-sat)
(assert (not (<= (- 72057594037927936) (+ (* weight_b b) (* weight_c c)) 72057594037927936)))
(check-sat)
(pop)

; ... and lies, by weight, between the lowest and the highest height, seen from the first corner's; raised it is
; positive and within 2^57.
;; shared/interpolation.hpp: const uint64_t raised = static_cast<uint64_t>(sum + w * 65536);
(push)
(declare-const weight_b Int)
(declare-const weight_c Int)
(declare-const w Int)
(declare-const a Int)
(declare-const b Int)
(declare-const c Int)
(assert (and (<= 0 weight_b) (<= 0 weight_c) (<= (+ weight_b weight_c) w) (<= 1 w 1099511627776)))
(assert (and (<= (- 32768) a 32767) (<= (- 32768) b 32767) (<= (- 32768) c 32767)))
(define-fun sum () Int (+ (* weight_b (- b a)) (* weight_c (- c a))))
(check-sat)
(assert (not (and (<= (* (- (- 32768) a) w) sum (* (- 32767 a) w))
                  (<= 0 (+ sum (* 65536 w)) 144115188075855872))))
(check-sat)
(pop)

; The quotient with one more bit is below 2^35; rounded, the height fits 32 bits.
;; shared/interpolation.hpp: const uint64_t rounded = (divide_finely(raised, static_cast<uint64_t>(w)) + 1) >> 1;
;; shared/interpolation.hpp: (static_cast<int64_t>(a.z) - 65536) * 65536);
(push)
(declare-const w Int)
(declare-const a Int)
(declare-const sum Int)
(declare-const quotient Int)
(declare-const lost Int)
(assert (and (<= 1 w 1099511627776) (<= (- 32768) a 32767)))
(assert (<= (* (- (- 32768) a) w) sum (* (- 32767 a) w)))
(assert (and (= (* 131072 (+ sum (* 65536 w))) (+ (* quotient w) lost)) (<= 0 lost) (< lost w)))
(define-fun rounded () Int (div (+ quotient 1) 2))
(check-sat)
(assert (not (and (<= 0 quotient) (< quotient 34359738368)
                  (<= (- 2147483648) (+ rounded (* 65536 (- a 65536))) 2147483647))))
(check-sat)
(pop)

; A real place on an axis: whole units times the denominator, less the offset, with the parts of the rest and a step,
; fit 64 bits; so do the first three of these alone.
;; decoder/axis.cpp: if (part.whole > divide(static_cast<uint64_t>(1) << 62, denominator).whole) return outside;
;; decoder/axis.cpp: const int64_t ahead = static_cast<int64_t>(part.whole + numerator) - axis.offset +
(push)
(declare-const product Int)
(declare-const offset Int)
(declare-const part Int)
(declare-const numerator Int)
(define-fun limit () Int 2305843009213693952)
(assert (and (< (- limit) offset limit) (<= (- (* -2 limit) 1099511627776) product (* 2 limit))))
(assert (and (<= 0 part 1099511627776) (<= 1 numerator 1099511627776)))
(define-fun before () Int (- (+ part numerator) offset))
(check-sat)
(assert (not (and (< -9223372036854775808 before 9223372036854775808)
                  (< -9223372036854775808 (+ before product) 9223372036854775808))))
(check-sat)
(pop)

; What is refused there is outside: a place from half a 1/256 step before the first to as much behind the last.
;; decoder/axis.cpp: if (part.whole > divide(static_cast<uint64_t>(1) << 62, denominator).whole) return outside;
(push)
(declare-const product Int)
(declare-const offset Int)
(declare-const denominator Int)
(declare-const numerator Int)
(declare-const reach Int)
(define-fun limit () Int 2305843009213693952)
(assert (and (< (- limit) offset limit) (<= 1 denominator 1099511627776) (<= 1 numerator 1099511627776)))
(assert (and (<= 0 reach) (< (+ reach numerator) limit)))
(assert (<= (- offset numerator denominator) product (+ offset reach numerator)))
(check-sat)
(assert (not (<= (* -2 limit) product (* 2 limit))))
(check-sat)
(pop)

; ... and the rest of a unit, brought to the same, is a part below the denominator.
;; decoder/axis.cpp: part = divide(rest * denominator, per_unit);                        // < 2^64; < 2^40
(push)
(declare-const per_unit Int)
(declare-const rest Int)
(declare-const denominator Int)
(declare-const part Int)
(declare-const left Int)
(assert (and (< 0 per_unit) (<= per_unit 16777216) (<= 0 rest) (< rest per_unit)))
(assert (and (< 0 denominator) (< denominator 1099511627776)))
(assert (and (= (* rest denominator) (+ (* part per_unit) left)) (<= 0 left) (< left per_unit)))
(check-sat)
(assert (not (and (< (* rest denominator) 18446744073709551616) (<= 0 part) (< part denominator))))
(check-sat)
(pop)
