; SPDX-License-Identifier: MIT
; Estimates need not be right, but their arithmetic must not overflow: cotangents, segments, circles, weights. A step of
; each is bounded by what proofs.md states of the one before.

; A cotangent's dividend fits 32 bits, and the result stays below its cap.
;; shared/free_region.hpp: return q * (static_cast<int32_t>(1) << kCotangentBits) / h;
(push)
(declare-const q Int)
(declare-const h Int)
(declare-const most Int)
(declare-const result Int)
(declare-const lost Int)
(assert (and (< 0 h 4096) (< 0 most 65) (<= 0 q (* h most))))  ; else mirrored
(assert (and (= (* 4096 q) (+ (* result h) lost)) (<= 0 lost) (< lost h)))
(check-sat)
(assert (not (and (< (* 4096 q) 2147483648) (<= result (* 4096 most)))))
(check-sat)
(pop)

; A minor segment: its dividend and its divisor fit, and it is at most 1592.
;; shared/free_region.hpp: return (k + 188u) * 174763u / (k * (k + 188u) + 20643u);
(push)
(declare-const k Int)
(declare-const result Int)
(assert (<= 0 k 16384))
(define-fun divisor () Int (+ 20643 (* k (+ k 188))))
(define-fun dividend () Int (* 174763 (+ k 188)))
(assert (and (<= 0 result) (<= (* result divisor) dividend)))
(check-sat)
(assert (not (and (< dividend 4294967296) (< divisor 4294967296) (<= result 1592))))
(check-sat)
(pop)

; Both segments of open sides, under at most 4 * 256, and the triangle fit 31 bits; so do those of circles behind, taken away.
;; shared/free_region.hpp: return (65536u + (k < 2048 ? k * k : 4194304u)) * 201u >> 15;
;; shared/free_region.hpp: const int32_t minor = static_cast<int32_t>((square >> 4) * minor_cap_under(size) >> 7);
;; shared/free_region.hpp: return static_cast<int32_t>((square >> 8) * whole_disc_under(size)) - minor;
(push)
(declare-const square Int)
(declare-const minor Int)
(declare-const kept Int)
(assert (and (<= 0 square 33554432) (<= 0 minor 1592) (<= 0 kept 2048)))
(define-fun major () Int (* (div square 256) 6834))  ; (65536 + 1024^2) 201 / 2^15
(define-fun behind () Int (* (div (div square 4) 256) 26130))  ; of a square below 2^23: (65536 + 2048^2) 201 / 2^15
(check-sat)
(assert (not (and (< (* (div square 16) minor) 4294967296) (< (* 201 (+ 65536 (* kept kept))) 4294967296)
                  (<= (div (* 201 (+ 65536 (* kept kept))) 32768) 26130) (< behind 1073741824)
                  (=> (<= kept 1024) (<= (div (* 201 (+ 65536 (* kept kept))) 32768) 6834))
                  (< (+ major major 8388608) 2147483648))))
(check-sat)
(pop)

; A circle's centre: of corners below 2^11 and a cotangent below 2^18.
;; shared/legal_places.hpp: return Spot{end.x + (k * end.y >> kCotangentBits), end.y - (k * end.x >> kCotangentBits)};
(push)
(declare-const k Int)
(declare-const x Int)
(declare-const y Int)
(assert (and (<= (- 262144) k 262144) (< (- 2048) x 2048) (< (- 2048) y 2048)))
(check-sat)
(assert (not (and (<= (- 536870912) (* k x) 536870912) (< (- 131072) (div (- y (div (* k x) 4096)) 2) 131072))))
(check-sat)
(pop)

; Squares at a column of the own circle (centre below 2^13, column below 2^14.5 = 23170) and of one behind (below 2^15).
;; shared/legal_places.hpp: return x * (circle.x2 - x) + circle.yy;
(push)
(declare-const x Int)
(declare-const x2 Int)
(declare-const y Int)
(assert (and (<= (- 23170) x 23170) (<= (- 36864) x2 36864) (<= (- 18432) y 18432)))  ; 2 (16 + 2) 2^11 / 2
(check-sat)
(assert (not (and (< (- 2147483648) (* x (- x2 x)) 2147483648)
                  (< (- 2147483648) (+ (* x (- x2 x)) (* y y)) 2147483648))))
(check-sat)
(pop)

; Squared distances of places from corners.
;; shared/place_odds.hpp: return (p.x - x) * (p.x - x) + (p.y - y) * (p.y - y);
(push)
(declare-const dx Int)
(declare-const dy Int)
(assert (and (<= (- 25218) dx 25218) (<= (- 38000) dy 38000)))  ; a row that only a circle behind tells may be below 2^15.2
(check-sat)
(assert (not (and (< (* dx dx) 2147483648) (< (+ (* dx dx) (* dy dy)) 2147483648))))
(check-sat)
(pop)

; The chance of being first, between two of the four that are found: the same as from + ((to - from) (3 f mod 256) >> 8).
;; shared/place_odds.hpp: odds.third[i] = Third{256 * (first - i * slope), slope};
;; shared/place_odds.hpp: return (third.start + static_cast<int32_t>(way) * third.slope) >> 8;
(push)
(declare-const f Int)
(declare-const from Int)
(declare-const to Int)
(assert (and (<= 0 f 255) (<= 0 from 511) (<= 0 to 511)))
(define-fun way () Int (* 3 f))
(define-fun third () Int (div way 256))
(define-fun slope () Int (- to from))
(define-fun start () Int (* 256 (- from (* third slope))))
(define-fun chance () Int (div (+ start (* way slope)) 256))
(check-sat)
(assert (not (and (<= 0 third 2) (< (- 524288) start 524288) (< (- 524288) (* way slope) 524288) (<= 0 chance 511)
                  (= chance (+ from (div (* slope (mod way 256)) 256))))))
(check-sat)
(pop)

; A half's share: columns' weights are below 2^14.6 = 24833, or twice that if not found there; times a count, at most 16.
;; shared/place_coding.hpp: const uint32_t share = (weight.high << 11) / (weight.low + weight.high + 1);
(push)
(declare-const low Int)
(declare-const high Int)
(declare-const share Int)
(assert (and (<= 1 low 794656) (<= 1 high 794656)))
(assert (and (<= 0 share) (<= (* share (+ low high 1)) (* 2048 high))))
(check-sat)
(assert (not (and (< (* 2048 high) 4294967296) (< share 2048))))
(check-sat)
(pop)

; A parity: counts of 1 to 511, together at most 512, times at most 16 lines.
;; shared/parity_coding.hpp: const int32_t probability = static_cast<int32_t>((odd << 15) / (even + odd));
(push)
(declare-const even Int)
(declare-const odd Int)
(declare-const probability Int)
(assert (and (<= 1 even 8176) (<= 1 odd 8176)))
(assert (and (<= 0 probability) (<= (* probability (+ even odd)) (* 32768 odd))))
(check-sat)
(assert (not (and (< (* 32768 odd) 4294967296) (< probability 32768))))
(check-sat)
(pop)
