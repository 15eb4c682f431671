; SPDX-License-Identifier: MIT
; Orientation and in-circle test on the 16-bit lattice. That the determinant is at most S^4 / 2 is proved in
; shared/docs/proofs.md, of which the steps that are algebra are here.

; A product of two offsets is below 2^32.
;; shared/predicates.hpp: return static_cast<int64_t>(a.x) * b.y - static_cast<int64_t>(a.y) * b.x;
(push)
(declare-const x Int)
(declare-const y Int)
(assert (and (<= (- 65535) x 65535) (<= (- 65535) y 65535)))
(check-sat)
(assert (not (< (- 4294967296) (* x y) 4294967296)))
(check-sat)
(pop)

; The angles' formula is the determinant of the lifted points.
;; shared/predicates.hpp: return static_cast<int64_t>(wrapping_product(c.q, p.h) - wrapping_product(p.q, c.h));
(push)
(declare-const ax Int) (declare-const ay Int) (declare-const bx Int) (declare-const by Int)
(declare-const cx Int) (declare-const cy Int)  ; p is the origin
(define-fun h_p () Int (- (* ax by) (* ay bx)))
(define-fun q_p () Int (+ (* ax bx) (* ay by)))
(define-fun h_c () Int (- (* (- ax cx) (- by cy)) (* (- ay cy) (- bx cx))))
(define-fun q_c () Int (+ (* (- ax cx) (- bx cx)) (* (- ay cy) (- by cy))))
(define-fun lift ((x Int) (y Int)) Int (+ (* x x) (* y y)))
(define-fun lifted () Int
  (+ (* (lift ax ay) (- (* bx cy) (* by cx))) (* (lift bx by) (- (* cx ay) (* cy ax)))
     (* (lift cx cy) (- (* ax by) (* ay bx)))))
(check-sat)
(assert (not (= (- (* q_c h_p) (* q_p h_c)) lifted)))
(check-sat)
(pop)

; The largest determinant, in units of S^4 / 4, where a and b are the distances from the diagonal.
;; shared/docs/proofs.md: determinant <= 2 (a + b)(1 - a b) L^4 <= 2 L^4 = S^4 / 2,    because a + b <= 1 + a b
(push)
(declare-const a Real)
(declare-const b Real)
(assert (and (<= 0 a 1) (<= 0 b 1)))
(check-sat)
(assert (not (and (<= (+ a b) (+ 1 (* a b))) (<= (* 2 (+ a b) (- 1 (* a b))) 2))))
(check-sat)
(pop)

; S^4 / 2 fits 63 bits for the lattice's largest coordinate, and would not for one more.
;; shared/lattice.hpp: constexpr uint16_t kLatticeMax = 65535;
(push)
(declare-const s Int)
(assert (= s 65535))
(check-sat)
(assert (not (and (< (div (* s s s s) 2) 9223372036854775807)
                  (<= 9223372036854775808 (div (* (+ s 1) (+ s 1) (+ s 1) (+ s 1)) 2)))))
(check-sat)
(pop)

; Of two triangles on either side of a diagonal, with all four points on a circle, exactly one is in conflict: a
; tie has one answer. The corners a, b, c, p turn counter-clockwise; their ranks are all different; a triangle of
; three is in conflict with the fourth unless that is the largest, or replacing the largest turns clockwise.
;; shared/predicates.hpp: return p < c && angle.h > 0;
(push)
(declare-const a Int) (declare-const b Int) (declare-const c Int) (declare-const p Int)
(assert (distinct a b c p))
(define-fun largest ((u Int) (v Int) (w Int) (x Int)) Bool (and (> u v) (> u w) (> u x)))
; (a, b, c) and p: in place of b, p turns clockwise, since it lies beyond a and c.
(define-fun abc () Bool (or (largest a p b c) (largest c p a b)))
(define-fun bcp () Bool (or (largest b a c p) (largest p a b c)))
(check-sat)
(assert (not (xor abc bcp)))
(check-sat)
(pop)
