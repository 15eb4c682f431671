; SPDX-License-Identifier: MIT
; The range coder: its interval never becomes empty, and nothing in it overflows.
(declare-const range Int)
(declare-const code Int)
(assert (and (<= 16777216 range) (< range 4294967296)))  ; between symbols
(assert (and (<= 0 code) (< code range)))

; A bit: both parts of the interval are at least 2^15 wide, and the code stays within its part.
;; decoder/range_decoder.hpp: const uint32_t bound = (range >> 15) * probability;
(push)
(declare-const probability Int)
(assert (<= 64 probability 32704))
(declare-const shifted Int)
(declare-const lost Int)
(assert (and (= range (+ (* 32768 shifted) lost)) (<= 0 lost 32767)))
(define-fun bound () Int (* shifted probability))
(define-fun new_range () Int (ite (< code bound) bound (- range bound)))
(define-fun new_code () Int (ite (< code bound) code (- code bound)))
(check-sat)
(assert (not (and (<= 32768 bound) (<= 32768 (- range bound)) (<= 0 new_code) (< new_code new_range))))
(check-sat)
(pop)

; A bit narrows the range by 513/512 at least (guarantees.md, proof of 21).
;; decoder/range_decoder.hpp: range = bound;
;; decoder/range_decoder.hpp: range -= bound;
(push)
(declare-const probability Int)
(assert (<= 64 probability 32704))
(declare-const shifted Int)
(declare-const lost Int)
(assert (and (= range (+ (* 32768 shifted) lost)) (<= 0 lost 32767)))
(define-fun bound () Int (* shifted probability))
(check-sat)
(assert (not (and (<= (* 513 bound) (* 512 range)) (<= (* 513 (- range bound)) (* 512 range)))))
(check-sat)
(pop)

; A number: what is left of the range is at least 2^8.
;; decoder/range_decoder.hpp: const uint32_t part = width / count;
(push)
(declare-const count Int)
(assert (<= 2 count 65536))
(declare-const part Int)
(declare-const lost Int)
(assert (and (= range (+ (* count part) lost)) (<= 0 lost) (< lost count)))
(check-sat)
(assert (not (<= 256 part)))
(check-sat)
(pop)

; ... and at most half of it, and the code stays within.
;; decoder/range_decoder.hpp: code -= value * part;
(push)
(declare-const count Int)
(assert (<= 2 count 65536))
(declare-const part Int)
(declare-const lost Int)
(assert (and (= range (+ (* count part) lost)) (<= 0 lost) (< lost count)))
(declare-const value Int)
(declare-const rest Int)
(assert (and (= code (+ (* value part) rest)) (<= 0 rest) (< rest part)))
(check-sat)
(assert (not (and (<= (* 2 part) range) (<= (* value part) code) (< (- code (* value part)) part))))
(check-sat)
(pop)

; A number or an escape: either leaves at least 2^8 of the range, and the code stays within.
;; decoder/range_decoder.hpp: return take(range - (range >> kEscapeBits), count);
;; decoder/range_decoder.hpp: range -= count * part;
(push)
(declare-const count Int)
(assert (<= 1 count 16384))
(declare-const escape Int)
(declare-const below Int)
(assert (and (= range (+ (* 1024 escape) below)) (<= 0 below) (< below 1024)))
(declare-const part Int)
(declare-const lost Int)
(assert (and (= (- range escape) (+ (* count part) lost)) (<= 0 lost) (< lost count)))
(declare-const value Int)
(declare-const rest Int)
(assert (and (= code (+ (* value part) rest)) (<= 0 rest) (< rest part)))
(define-fun kept () Int (ite (< value count) part (- range (* count part))))
(define-fun new_code () Int (ite (< value count) rest (- code (* count part))))
(check-sat)
(assert (not (and (<= 256 kept) (<= 0 new_code) (< new_code kept) (< (* count part) range))))
(check-sat)
(pop)

; Reading bytes: twice at most, nothing is shifted out, and the code stays below the range.
;; decoder/range_decoder.hpp: code = code << 8 | next_byte();
(push)
(declare-const part Int)
(declare-const rest Int)
(declare-const byte Int)
(assert (and (<= 256 part) (< part 16777216) (<= 0 rest) (< rest part) (<= 0 byte 255)))
(define-fun shifted () Int (* 256 part))
(check-sat)
(assert (not (and (< shifted 4294967296) (< (+ (* 256 rest) byte) shifted) (<= 16777216 (* 256 shifted)))))
(check-sat)
(pop)

; A learned bit keeps its margins.
;; shared/probability.hpp: bit.fast = static_cast<uint16_t>(bit.fast + ((towards - bit.fast) >> 5));
;; shared/probability.hpp: bit.slow = static_cast<uint16_t>(bit.slow + ((towards - bit.slow) >> 8));
(push)
(declare-const old Int)
(declare-const towards Int)
(assert (and (<= 64 old 32704) (or (= towards 64) (= towards 32704))))
(define-fun fast () Int (+ old (div (- towards old) 32)))
(define-fun slow () Int (+ old (div (- towards old) 256)))
(check-sat)
(assert (not (and (<= 64 fast 32704) (<= 64 slow 32704))))
(check-sat)
(pop)

; So does what lies between two of them.
;; shared/probability.hpp: const int32_t between = from + ((to - from) * static_cast<int32_t>(share) >> 8);
(push)
(declare-const from Int)
(declare-const to Int)
(declare-const share Int)
(assert (and (<= 128 from 65408) (<= 128 to 65408) (<= 0 share 255)))
(define-fun product () Int (* (- to from) share))
(define-fun between () Int (+ from (div product 256)))
(check-sat)
(assert (not (and (< (- 2147483648) product 2147483648) (<= 64 (div between 2) 32704))))
(check-sat)
(pop)
