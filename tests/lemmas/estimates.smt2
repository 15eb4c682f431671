; SPDX-License-Identifier: MIT
; Estimates need not be right, but their arithmetic must not overflow: cotangents, circles, cells, repulsion.

; A cotangent: 256 times what is left of q fits 32 bits, and the result stays below its cap.
;; shared/free_region.hpp: return kept_within(scaled(q, 1, shift), 89 * divisor) * 256 / divisor;
(push)
(declare-const q Int)
(declare-const divisor Int)
(declare-const result Int)
(declare-const lost Int)
(assert (and (< 0 divisor 65536) (<= (* -89 divisor) q (* 89 divisor))))
(assert (and (<= 0 q) (= (* 256 q) (+ (* result divisor) lost)) (<= 0 lost) (< lost divisor)))  ; else mirrored
(check-sat)
(assert (not (and (< (* 256 q) 2147483648) (< (* 89 divisor) 2147483648) (<= result 22784))))
(check-sat)
(pop)

; A disc: the square of a cotangent fits 32 bits, the products 63.
;; shared/free_region.hpp: return scaled(length2, (65536 + k * k) >> 8, 8) * 201;
;; shared/free_region.hpp: return static_cast<int32_t>(static_cast<int64_t>(65536 + k * k) * 3217 >> 11) - smaller;
(push)
(declare-const k Int)
(declare-const length2 Int)
(assert (and (<= (- 23000) k 23000) (<= 0 length2 8589672450)))  ; 2 * 65535^2
(define-fun square () Int (+ 65536 (* k k)))
(check-sat)
(assert (not (and (< square 2147483648) (<= (div square 256) 2066662))))
(check-sat)
(pop)

; ... with its square bounded so.
;; shared/free_region.hpp: typedef int64_t Area;
(push)
(declare-const square Int)
(declare-const length2 Int)
(assert (and (<= 65536 square 529065536) (<= 0 length2 8589672450)))
(define-fun part () Int (div square 256))
(define-fun product () Int (* length2 part))
(check-sat)
(assert (not (and (< product 9223372036854775808) (< (* 201 (div product 256)) 288230376151711744)
                  (< (* length2 square) 4611686018427387904))))
(check-sat)
(pop)

; A circle over a chord: the cotangent's product fits 52 bits, slopes 29.
;; shared/free_region.hpp: power.value = dot(a, b) - scaled(cross(chord, a), k, 8);
;; shared/free_region.hpp: power.x = 16 * (a.x + b.x) + static_cast<FastInt>(static_cast<int64_t>(k) * chord.y >> 4);
(push)
(declare-const k Int)
(declare-const x Int)
(declare-const y Int)
(assert (and (<= (- 25048) k 23000)))  ; the cap, and 2048 more where nothing is behind the chord
(assert (and (<= (- 262144) x 262144) (<= (- 262144) y 262144)))
(declare-const cross Int)
(assert (<= (- 137438953472) cross 137438953472))  ; two such products
(declare-const chord Int)
(assert (<= (- 131070) chord 131070))
(check-sat)
(assert (not (and (<= (- 68719476736) (* x y) 68719476736)
                  (< (- 536870912) (+ (* 16 (+ x y)) (div (* k chord) 16)) 536870912)
                  (<= (- 4503599627370496) (* k cross) 4503599627370496))))
(check-sat)
(pop)

; The ramp that scales distances is below 2^50.
;; shared/cells.hpp: return scale_by(((x * width + y * height) * 4 + width * width + height * height) / 8 + 24);
(push)
(declare-const x Int)
(declare-const y Int)
(declare-const width Int)
(declare-const height Int)
(assert (and (<= 0 x) (< x 33554432) (<= 0 y) (< y 33554432)))  ; whole steps of slopes
(assert (and (<= 4 width) (< width 262144) (<= 4 height) (< height 262144)))
(check-sat)
(define-fun ramp () Int (+ 24 (div (+ (* 4 (+ (* x width) (* y height))) (* width width) (* height height)) 8)))
(assert (not (and (<= 28 ramp) (< ramp 1125899906842624))))
(check-sat)
(pop)

; Its reciprocal is within 2^14 .. 2^26; `mantissa` is the ramp without its low bits.
;; shared/cells.hpp: return Scale{shift, static_cast<int32_t>((static_cast<uint32_t>(1) << 30) /
(push)
(declare-const mantissa Int)
(declare-const reciprocal Int)
(declare-const lost Int)
(assert (<= 28 mantissa 65535))
(assert (and (= 1073741824 (+ (* reciprocal mantissa) lost)) (<= 0 lost) (< lost mantissa)))
(check-sat)
(assert (not (<= 16384 reciprocal 67108864)))
(check-sat)
(pop)

; Slopes and powers times it fit 63 bits.
;; shared/cells.hpp: static_cast<int16_t>(scaled(slope, scale.reciprocal, scale.shift + slices.unit + 7));
;; shared/cells.hpp: value = kept_within(scaled(value, scale.reciprocal, 21), 1 << 13);
(push)
(declare-const slope Int)
(declare-const value Int)
(declare-const reciprocal Int)
(assert (and (<= (- 536870912) slope 536870912) (<= (- 1073741824) value 1073741824) (<= 16384 reciprocal 67108864)))
(check-sat)
(assert (not (and (<= (- 36028797018963968) (* slope reciprocal) 36028797018963968)
                  (<= (- 72057594037927936) (* value reciprocal) 72057594037927936))))
(check-sat)
(pop)

; The parabola of an axis fits 32 bits.
;; shared/cells.hpp: static_cast<int16_t>(constant + (static_cast<int32_t>(slices.middle[i]) * linear >> 16) +
(push)
(declare-const constant Int)
(declare-const middle Int)
(declare-const linear Int)
(declare-const square Int)
(declare-const bend Int)
(assert (and (<= (- 8192) constant 8192) (<= (- 24576) middle 24576) (<= 0 square 9216)))
(assert (and (<= (- 32768) linear 32767) (<= (- 32768) bend 32767)))
(check-sat)
(assert (not (and (< (- 2147483648) (* middle linear) 2147483648) (< (- 2147483648) (* square bend) 2147483648))))
(check-sat)
(pop)

; Repulsion: half steps of a box of 2^size .. 2^(size + 1) - 1 steps, in units of at most 2^(27 - size); `power` is
; 2^size.
;; shared/repulsion.hpp: return static_cast<int16_t>(static_cast<int32_t>(half_steps) * unit >> 16);
(push)
(declare-const power Int)
(declare-const unit Int)
(declare-const half_steps Int)
(assert (and (<= 1 power 65536) (<= 1 unit) (<= (* unit power) 134217728)))
(assert (< (* -2 power) half_steps (* 2 power)))
(check-sat)
(assert (not (and (<= (- 268435456) (* half_steps unit) 268435456) (<= -4096 (div (* half_steps unit) 65536) 4096))))
(check-sat)
(pop)
