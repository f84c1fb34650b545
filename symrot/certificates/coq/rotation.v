(* Rotations of a rigid body over the real numbers: what the theorems of the other files are about, and the rules
   that prove them. Coq's standard library alone. Definitions first: they are what a reader has to agree with. *)

From Coq Require Import Reals Lra.
Open Scope R_scope.

(* --- vectors, matrices, quaternions ------------------------------------------------------------------------------- *)

Record vector := vec { x1 : R; x2 : R; x3 : R }.

Record matrix := mat {
  m11 : R; m12 : R; m13 : R;
  m21 : R; m22 : R; m23 : R;
  m31 : R; m32 : R; m33 : R }.

Record quaternion := quat { h0 : R; h1 : R; h2 : R; h3 : R }. (* scalar first *)

Definition identity : matrix := mat 1 0 0  0 1 0  0 0 1.

Definition vadd (v w : vector) : vector := vec (x1 v + x1 w) (x2 v + x2 w) (x3 v + x3 w).

Definition dot (v w : vector) : R := x1 v * x1 w + x2 v * x2 w + x3 v * x3 w.

Definition cross (v w : vector) : vector :=
  vec (x2 v * x3 w - x3 v * x2 w) (x3 v * x1 w - x1 v * x3 w) (x1 v * x2 w - x2 v * x1 w).

Definition skew (v : vector) : matrix := (* skew v *v w = cross v w *)
  mat 0 (- x3 v) (x2 v)
      (x3 v) 0 (- x1 v)
      (- x2 v) (x1 v) 0.

Definition transpose (a : matrix) : matrix :=
  mat (m11 a) (m21 a) (m31 a)
      (m12 a) (m22 a) (m32 a)
      (m13 a) (m23 a) (m33 a).

Definition det (a : matrix) : R :=
  m11 a * (m22 a * m33 a - m23 a * m32 a)
  - m12 a * (m21 a * m33 a - m23 a * m31 a)
  + m13 a * (m21 a * m32 a - m22 a * m31 a).

Definition madd (a b : matrix) : matrix :=
  mat (m11 a + m11 b) (m12 a + m12 b) (m13 a + m13 b)
      (m21 a + m21 b) (m22 a + m22 b) (m23 a + m23 b)
      (m31 a + m31 b) (m32 a + m32 b) (m33 a + m33 b).

Definition msub (a b : matrix) : matrix :=
  mat (m11 a - m11 b) (m12 a - m12 b) (m13 a - m13 b)
      (m21 a - m21 b) (m22 a - m22 b) (m23 a - m23 b)
      (m31 a - m31 b) (m32 a - m32 b) (m33 a - m33 b).

Definition mmul (a b : matrix) : matrix :=
  mat (m11 a * m11 b + m12 a * m21 b + m13 a * m31 b)
      (m11 a * m12 b + m12 a * m22 b + m13 a * m32 b)
      (m11 a * m13 b + m12 a * m23 b + m13 a * m33 b)
      (m21 a * m11 b + m22 a * m21 b + m23 a * m31 b)
      (m21 a * m12 b + m22 a * m22 b + m23 a * m32 b)
      (m21 a * m13 b + m22 a * m23 b + m23 a * m33 b)
      (m31 a * m11 b + m32 a * m21 b + m33 a * m31 b)
      (m31 a * m12 b + m32 a * m22 b + m33 a * m32 b)
      (m31 a * m13 b + m32 a * m23 b + m33 a * m33 b).

Definition mulv (a : matrix) (v : vector) : vector :=
  vec (m11 a * x1 v + m12 a * x2 v + m13 a * x3 v)
      (m21 a * x1 v + m22 a * x2 v + m23 a * x3 v)
      (m31 a * x1 v + m32 a * x2 v + m33 a * x3 v).

Infix "*m" := mmul (at level 40, left associativity).
Infix "*v" := mulv (at level 40, left associativity).

Definition qmul (p q : quaternion) : quaternion := (* of Hamilton: i j = k *)
  quat (h0 p * h0 q - h1 p * h1 q - h2 p * h2 q - h3 p * h3 q)
       (h0 p * h1 q + h1 p * h0 q + h2 p * h3 q - h3 p * h2 q)
       (h0 p * h2 q - h1 p * h3 q + h2 p * h0 q + h3 p * h1 q)
       (h0 p * h3 q + h1 p * h2 q - h2 p * h1 q + h3 p * h0 q).

Infix "*q" := qmul (at level 40, left associativity).

Definition conjugate (q : quaternion) : quaternion := quat (h0 q) (- h1 q) (- h2 q) (- h3 q).

Definition pure (v : vector) : quaternion := quat 0 (x1 v) (x2 v) (x3 v).

Definition norm2 (q : quaternion) : R := h0 q ^ 2 + h1 q ^ 2 + h2 q ^ 2 + h3 q ^ 2.

(* --- rotations ---------------------------------------------------------------------------------------------------- *)

(* right-handed turns about the three axes, active: Rz a *v w is w turned about the third axis by the angle a (rad) *)

Definition Rx (a : R) : matrix :=
  mat 1 0 0
      0 (cos a) (- sin a)
      0 (sin a) (cos a).

Definition Ry (a : R) : matrix :=
  mat (cos a) 0 (sin a)
      0 1 0
      (- sin a) 0 (cos a).

Definition Rz (a : R) : matrix :=
  mat (cos a) (- sin a) 0
      (sin a) (cos a) 0
      0 0 1.

Definition rotation (a : matrix) : Prop := (* orthonormal and right-handed *)
  transpose a *m a = identity /\ det a = 1.

Definition represents (q : quaternion) (a : matrix) : Prop := (* q v q* is the vector v turned by a *)
  norm2 q = 1 /\ forall v, q *q pure v *q conjugate q = pure (a *v v).

(* --- inertia ------------------------------------------------------------------------------------------------------ *)

Definition tensor (xx yy zz xy xz yz : R) : matrix := (* products of inertia with their minus sign *)
  mat xx xy xz
      xy yy yz
      xz yz zz.

(* --- derivatives -------------------------------------------------------------------------------------------------- *)

(* derivable_pt_lim f t d, of the standard library: f has the derivative d at t *)

Definition vderivative (f : R -> vector) (t : R) (d : vector) : Prop :=
  derivable_pt_lim (fun u => x1 (f u)) t (x1 d) /\
  derivable_pt_lim (fun u => x2 (f u)) t (x2 d) /\
  derivable_pt_lim (fun u => x3 (f u)) t (x3 d).

Definition derivative (f : R -> matrix) (t : R) (d : matrix) : Prop :=
  derivable_pt_lim (fun u => m11 (f u)) t (m11 d) /\
  derivable_pt_lim (fun u => m12 (f u)) t (m12 d) /\
  derivable_pt_lim (fun u => m13 (f u)) t (m13 d) /\
  derivable_pt_lim (fun u => m21 (f u)) t (m21 d) /\
  derivable_pt_lim (fun u => m22 (f u)) t (m22 d) /\
  derivable_pt_lim (fun u => m23 (f u)) t (m23 d) /\
  derivable_pt_lim (fun u => m31 (f u)) t (m31 d) /\
  derivable_pt_lim (fun u => m32 (f u)) t (m32 d) /\
  derivable_pt_lim (fun u => m33 (f u)) t (m33 d).

(* --- rules: nothing below needs to be read to trust the theorems -------------------------------------------------- *)

Lemma derivative_is : forall f t d e, derivable_pt_lim f t d -> d = e -> derivable_pt_lim f t e.
Proof. intros f t d e H E. rewrite <- E. exact H. Qed.

Lemma d_constant : forall c t, derivable_pt_lim (fun _ => c) t 0.
Proof. exact derivable_pt_lim_const. Qed.

Lemma d_plus : forall f g t f' g', derivable_pt_lim f t f' -> derivable_pt_lim g t g' ->
  derivable_pt_lim (fun u => f u + g u) t (f' + g').
Proof. exact derivable_pt_lim_plus. Qed.

Lemma d_minus : forall f g t f' g', derivable_pt_lim f t f' -> derivable_pt_lim g t g' ->
  derivable_pt_lim (fun u => f u - g u) t (f' - g').
Proof. exact derivable_pt_lim_minus. Qed.

Lemma d_opposite : forall f t f', derivable_pt_lim f t f' -> derivable_pt_lim (fun u => - f u) t (- f').
Proof. exact derivable_pt_lim_opp. Qed.

Lemma d_times : forall f g t f' g', derivable_pt_lim f t f' -> derivable_pt_lim g t g' ->
  derivable_pt_lim (fun u => f u * g u) t (f' * g t + f t * g').
Proof. exact derivable_pt_lim_mult. Qed.

Lemma d_over : forall f g t f' g', derivable_pt_lim f t f' -> derivable_pt_lim g t g' -> g t <> 0 ->
  derivable_pt_lim (fun u => f u / g u) t ((f' * g t - g' * f t) / Rsqr (g t)).
Proof. exact derivable_pt_lim_div. Qed.

Lemma d_sine : forall f t f', derivable_pt_lim f t f' -> derivable_pt_lim (fun u => sin (f u)) t (cos (f t) * f').
Proof. intros f t f' H. exact (derivable_pt_lim_comp f sin t f' (cos (f t)) H (derivable_pt_lim_sin (f t))). Qed.

Lemma d_cosine : forall f t f', derivable_pt_lim f t f' -> derivable_pt_lim (fun u => cos (f u)) t (- sin (f t) * f').
Proof. intros f t f' H. exact (derivable_pt_lim_comp f cos t f' (- sin (f t)) H (derivable_pt_lim_cos (f t))). Qed.

Lemma d_same : forall f g t d, (forall u, f u = g u) -> derivable_pt_lim g t d -> derivable_pt_lim f t d.
Proof.
  intros f g t d E H e P. destruct (H e P) as [delta K]. exists delta. intros h N S. rewrite !E. exact (K h N S).
Qed.

Lemma d_square : forall f t f', derivable_pt_lim f t f' -> derivable_pt_lim (fun u => f u ^ 2) t (2 * f t * f').
Proof.
  intros f t f' H. apply (d_same _ (fun u => f u * f u)); [intro u; ring|].
  apply (derivative_is _ _ _ _ (d_times _ _ _ _ _ H H)). ring.
Qed.

Lemma d_cube : forall f t f', derivable_pt_lim f t f' -> derivable_pt_lim (fun u => f u ^ 3) t (3 * f t ^ 2 * f').
Proof.
  intros f t f' H. apply (d_same _ (fun u => f u ^ 2 * f u)); [intro u; ring|].
  apply (derivative_is _ _ _ _ (d_times _ _ _ _ _ (d_square _ _ _ H) H)). ring.
Qed.

Lemma d_fourth : forall f t f', derivable_pt_lim f t f' -> derivable_pt_lim (fun u => f u ^ 4) t (4 * f t ^ 3 * f').
Proof.
  intros f t f' H. apply (d_same _ (fun u => f u ^ 3 * f u)); [intro u; ring|].
  apply (derivative_is _ _ _ _ (d_times _ _ _ _ _ (d_cube _ _ _ H) H)). ring.
Qed.

Ltac differentiate := (* from the hypotheses, by the rules above; what is divided by is not zero by hypothesis *)
  first [ eassumption
        | apply d_constant
        | eapply d_square; differentiate
        | eapply d_cube; differentiate
        | eapply d_fourth; differentiate
        | eapply d_plus; [differentiate | differentiate]
        | eapply d_minus; [differentiate | differentiate]
        | eapply d_opposite; differentiate
        | eapply d_times; [differentiate | differentiate]
        | eapply d_over; [differentiate | differentiate | assumption]
        | eapply d_sine; differentiate
        | eapply d_cosine; differentiate ].

Ltac spread := (* write vectors, matrices and quaternions out in their components *)
  cbv beta zeta delta [
    identity vadd dot cross skew transpose det madd msub mmul mulv qmul conjugate pure norm2 Rx Ry Rz
    vderivative derivative];
  cbn [x1 x2 x3 m11 m12 m13 m21 m22 m23 m31 m32 m33 h0 h1 h2 h3].

Lemma sine_square : forall a, sin a * sin a = 1 - cos a * cos a.
Proof. intro a. pose proof (sin2_cos2 a) as H. unfold Rsqr in H. lra. Qed.

Ltac by_ring := spread; f_equal; ring.

Lemma mmul_assoc : forall a b c, a *m b *m c = a *m (b *m c).
Proof. intros. by_ring. Qed.

Lemma mulv_mmul : forall a b v, a *m b *v v = a *v (b *v v).
Proof. intros. by_ring. Qed.

Lemma mmul_identity : forall a, a *m identity = a.
Proof. intros []. by_ring. Qed.

Lemma identity_mmul : forall a, identity *m a = a.
Proof. intros []. by_ring. Qed.

Lemma identity_mulv : forall v, identity *v v = v.
Proof. intros []. by_ring. Qed.

Lemma transpose_mmul : forall a b, transpose (a *m b) = transpose b *m transpose a.
Proof. intros. by_ring. Qed.

Lemma skew_injective : forall v w, skew v = skew w -> v = w.
Proof. intros [a b c] [d e f] H. injection H. intros. subst. reflexivity. Qed.

Definition adjugate (a : matrix) : matrix :=
  mat (m22 a * m33 a - m23 a * m32 a) (m13 a * m32 a - m12 a * m33 a) (m12 a * m23 a - m13 a * m22 a)
      (m23 a * m31 a - m21 a * m33 a) (m11 a * m33 a - m13 a * m31 a) (m13 a * m21 a - m11 a * m23 a)
      (m21 a * m32 a - m22 a * m31 a) (m12 a * m31 a - m11 a * m32 a) (m11 a * m22 a - m12 a * m21 a).

Lemma cramer : forall a v, adjugate a *v (a *v v) = vec (det a * x1 v) (det a * x2 v) (det a * x3 v).
Proof. intros. unfold adjugate. by_ring. Qed.

Lemma mulv_injective : forall a v w, det a <> 0 -> a *v v = a *v w -> v = w.
Proof.
  intros a v w N H. assert (E : adjugate a *v (a *v v) = adjugate a *v (a *v w)) by (rewrite H; reflexivity).
  rewrite !cramer in E. injection E. intros E3 E2 E1. destruct v, w. cbn in E1, E2, E3.
  f_equal; apply (Rmult_eq_reg_l (det a)); assumption.
Qed.

(* --- rotations form a group, and the elementary ones are rotations --- *)

Ltac by_circle a := (* equal components, up to sin^2 + cos^2 = 1 *)
  spread; f_equal; ring [(sine_square a)].

Lemma Rx_rotation : forall a, rotation (Rx a).
Proof. intro a. split; by_circle a. Qed.

Lemma Ry_rotation : forall a, rotation (Ry a).
Proof. intro a. split; by_circle a. Qed.

Lemma Rz_rotation : forall a, rotation (Rz a).
Proof. intro a. split; by_circle a. Qed.

Lemma mmul_adjugate : forall a, det a = 1 -> a *m adjugate a = identity.
Proof. intros a H. unfold adjugate. unfold det in H. spread. f_equal; try ring; rewrite <- H; ring. Qed.

Lemma transpose_is_adjugate : forall a, rotation a -> transpose a = adjugate a.
Proof.
  intros a [O H]. rewrite <- (mmul_identity (transpose a)), <- (mmul_adjugate a H), <- mmul_assoc, O.
  apply identity_mmul.
Qed.

Lemma mmul_transpose : forall a, rotation a -> a *m transpose a = identity.
Proof. intros a N. rewrite (transpose_is_adjugate a N). apply mmul_adjugate. exact (proj2 N). Qed.

Lemma transpose_skew_mmul : forall a v, transpose a *m skew v *m a = skew (adjugate a *v v).
Proof. intros. unfold adjugate. by_ring. Qed.

Lemma skew_mmul : forall a v, rotation a -> skew v *m a = a *m skew (transpose a *v v).
Proof.
  intros a v N. rewrite (transpose_is_adjugate a N), <- transpose_skew_mmul, <- !mmul_assoc, (mmul_transpose a N).
  rewrite identity_mmul. reflexivity.
Qed.

Lemma det_mmul : forall a b, det (a *m b) = det a * det b.
Proof. intros. spread. ring. Qed.

Lemma rotation_mmul : forall a b, rotation a -> rotation b -> rotation (a *m b).
Proof.
  intros a b [A P] [B Q]. split.
  - rewrite transpose_mmul, mmul_assoc, <- (mmul_assoc (transpose a)), A, identity_mmul. exact B.
  - rewrite det_mmul, P, Q. ring.
Qed.

Lemma skew_of_turned : forall a v, rotation a -> a *m skew v = skew (a *v v) *m a.
Proof.
  intros a v N. rewrite (skew_mmul a _ N), <- mulv_mmul, (proj1 N), identity_mulv. reflexivity.
Qed.

Lemma body_skew_injective : forall a v w, rotation a -> a *m skew v = a *m skew w -> v = w.
Proof.
  intros a v w [A1 _] H. apply skew_injective. rewrite <- (identity_mmul (skew v)), <- (identity_mmul (skew w)).
  rewrite <- A1, !mmul_assoc, H. reflexivity.
Qed.

Lemma space_skew_injective : forall a v w, rotation a -> skew v *m a = skew w *m a -> v = w.
Proof.
  intros a v w N H. apply skew_injective. rewrite <- (mmul_identity (skew v)), <- (mmul_identity (skew w)).
  rewrite <- (mmul_transpose a N), <- !mmul_assoc, H. reflexivity.
Qed.

(* --- derivatives of matrices --- *)

Ltac entry_by_entry :=
  unfold derivative, vderivative; spread;
  repeat match goal with |- _ /\ _ => split end; (eapply derivative_is; [differentiate | cbv beta; try ring]).

Lemma derivative_unique : forall F t D E, derivative F t D -> derivative F t E -> D = E.
Proof.
  intros F t [] []. unfold derivative. spread. intros H K. decompose [and] H. decompose [and] K.
  f_equal; eapply uniqueness_limite; eassumption.
Qed.

Lemma derivative_same : forall F G t D, (forall u, F u = G u) -> derivative G t D -> derivative F t D.
Proof.
  intros F G t D E H. unfold derivative in *. decompose [and] H.
  repeat split; (eapply d_same; [intro u; rewrite E; reflexivity | assumption]).
Qed.

Lemma d_mmul : forall F G t F' G', derivative F t F' -> derivative G t G' -> (* the product rule *)
  derivative (fun u => F u *m G u) t (madd (F' *m G t) (F t *m G')).
Proof.
  intros F G t F' G' H K. unfold derivative in H, K. decompose [and] H. decompose [and] K. clear H K.
  entry_by_entry.
Qed.

Lemma d_mulv : forall F v t F' v', derivative F t F' -> vderivative v t v' ->
  vderivative (fun u => F u *v v u) t (vadd (F' *v v t) (F t *v v')).
Proof.
  intros F v t F' v' H K. unfold derivative in H. unfold vderivative in K. decompose [and] H. decompose [and] K.
  clear H K. entry_by_entry.
Qed.

Lemma d_transpose : forall F t F', derivative F t F' -> derivative (fun u => transpose (F u)) t (transpose F').
Proof. intros F t F' H. unfold derivative in H. decompose [and] H. repeat split; assumption. Qed.

Lemma Rx_body : forall a t a', derivable_pt_lim a t a' ->
  derivative (fun u => Rx (a u)) t (Rx (a t) *m skew (vec a' 0 0)).
Proof. intros. entry_by_entry. Qed.

Lemma Ry_body : forall a t a', derivable_pt_lim a t a' ->
  derivative (fun u => Ry (a u)) t (Ry (a t) *m skew (vec 0 a' 0)).
Proof. intros. entry_by_entry. Qed.

Lemma Rz_body : forall a t a', derivable_pt_lim a t a' ->
  derivative (fun u => Rz (a u)) t (Rz (a t) *m skew (vec 0 0 a')).
Proof. intros. entry_by_entry. Qed.

Lemma Rx_space : forall a t a', derivable_pt_lim a t a' ->
  derivative (fun u => Rx (a u)) t (skew (vec a' 0 0) *m Rx (a t)).
Proof. intros. entry_by_entry. Qed.

Lemma Ry_space : forall a t a', derivable_pt_lim a t a' ->
  derivative (fun u => Ry (a u)) t (skew (vec 0 a' 0) *m Ry (a t)).
Proof. intros. entry_by_entry. Qed.

Lemma Rz_space : forall a t a', derivable_pt_lim a t a' ->
  derivative (fun u => Rz (a u)) t (skew (vec 0 0 a') *m Rz (a t)).
Proof. intros. entry_by_entry. Qed.

(* --- angular velocities add --- *)

Lemma mmul_madd_skew : forall a v w, madd (a *m skew v) (a *m skew w) = a *m skew (vadd v w).
Proof. intros. by_ring. Qed.

Lemma madd_skew_mmul : forall a v w, madd (skew v *m a) (skew w *m a) = skew (vadd v w) *m a.
Proof. intros. by_ring. Qed.

Lemma body_add : forall F G t v w, rotation (G t) ->
  derivative F t (F t *m skew v) -> derivative G t (G t *m skew w) ->
  derivative (fun u => F u *m G u) t (F t *m G t *m skew (vadd (transpose (G t) *v v) w)).
Proof.
  intros F G t v w N H K. rewrite <- mmul_madd_skew, mmul_assoc, <- (skew_mmul _ _ N), <- mmul_assoc, mmul_assoc.
  rewrite (mmul_assoc (F t) (G t)), <- (mmul_assoc (F t) (skew v)). exact (d_mmul _ _ _ _ _ H K).
Qed.

Lemma space_add : forall F G t v w, rotation (F t) ->
  derivative F t (skew v *m F t) -> derivative G t (skew w *m G t) ->
  derivative (fun u => F u *m G u) t (skew (vadd v (F t *v w)) *m (F t *m G t)).
Proof.
  intros F G t v w N H K. rewrite <- madd_skew_mmul, <- (mmul_assoc (skew (F t *v w))), <- skew_of_turned by exact N.
  rewrite <- mmul_assoc, (mmul_assoc (F t) (skew w)). exact (d_mmul _ _ _ _ _ H K).
Qed.

Lemma three_turns_body : forall D F G H t u v w omega, (forall x, D x = F x *m G x *m H x) ->
  rotation (G t) -> rotation (H t) ->
  derivative F t (F t *m skew u) -> derivative G t (G t *m skew v) -> derivative H t (H t *m skew w) ->
  vadd (transpose (H t) *v vadd (transpose (G t) *v u) v) w = omega ->
  derivative D t (D t *m skew omega).
Proof.
  intros D F G H t u v w omega E RG RH KF KG KH <-. rewrite E. apply (derivative_same _ _ _ _ E).
  exact (body_add (fun x => F x *m G x) H t _ _ RH (body_add F G t _ _ RG KF KG) KH).
Qed.

Lemma three_turns_space : forall D F G H t u v w omega, (forall x, D x = F x *m G x *m H x) ->
  rotation (F t) -> rotation (G t) ->
  derivative F t (skew u *m F t) -> derivative G t (skew v *m G t) -> derivative H t (skew w *m H t) ->
  vadd u (F t *v vadd v (G t *v w)) = omega ->
  derivative D t (skew omega *m D t).
Proof.
  intros D F G H t u v w omega E RF RG KF KG KH <-. rewrite E, mmul_assoc.
  apply (derivative_same _ (fun x => F x *m (G x *m H x))); [intro x; rewrite E; apply mmul_assoc|].
  exact (space_add F (fun x => G x *m H x) t _ _ RF KF (space_add G H t _ _ RG KG KH)).
Qed.

(* --- rates of parameters: those given are the only ones --- *)

Lemma only_body_rates : forall D t b dp rates omega, rotation (D t) ->
  derivative D t (D t *m skew (b *v dp)) -> det b <> 0 -> b *v rates = omega ->
  (derivative D t (D t *m skew omega) <-> dp = rates).
Proof.
  intros D t b dp rates omega N H K E. split; intro P.
  - apply (mulv_injective b _ _ K). rewrite E. apply (body_skew_injective (D t) _ _ N).
    exact (derivative_unique _ _ _ _ H P).
  - rewrite <- E, <- P. exact H.
Qed.

Lemma only_space_rates : forall D t b dp rates omega, rotation (D t) ->
  derivative D t (skew (b *v dp) *m D t) -> det b <> 0 -> b *v rates = omega ->
  (derivative D t (skew omega *m D t) <-> dp = rates).
Proof.
  intros D t b dp rates omega N H K E. split; intro P.
  - apply (mulv_injective b _ _ K). rewrite E. apply (space_skew_injective (D t) _ _ N).
    exact (derivative_unique _ _ _ _ H P).
  - rewrite <- E, <- P. exact H.
Qed.

(* --- quaternions --- *)

Lemma qmul_assoc : forall p q r, p *q q *q r = p *q (q *q r).
Proof. intros. by_ring. Qed.

Lemma conjugate_qmul : forall p q, conjugate (p *q q) = conjugate q *q conjugate p.
Proof. intros. by_ring. Qed.

Lemma norm2_qmul : forall p q, norm2 (p *q q) = norm2 p * norm2 q.
Proof. intros. spread. ring. Qed.

Lemma represents_qmul : forall p q a b, represents p a -> represents q b -> represents (p *q q) (a *m b).
Proof.
  intros p q a b [P A] [Q B]. split.
  - rewrite norm2_qmul, P, Q. ring.
  - intro v. rewrite conjugate_qmul, mulv_mmul, <- A, <- B, !qmul_assoc. reflexivity.
Qed.

Definition Qx (a : R) : quaternion := quat (cos (a / 2)) (sin (a / 2)) 0 0.
Definition Qy (a : R) : quaternion := quat (cos (a / 2)) 0 (sin (a / 2)) 0.
Definition Qz (a : R) : quaternion := quat (cos (a / 2)) 0 0 (sin (a / 2)).

Ltac by_half_angle a := (* equal components, in the sine and cosine of half the angle *)
  replace (cos a) with (1 - 2 * sin (a / 2) * sin (a / 2)) by (rewrite <- cos_2a_sin; f_equal; field);
  replace (sin a) with (2 * sin (a / 2) * cos (a / 2)) by (rewrite <- sin_2a; f_equal; field);
  try f_equal; ring [(sine_square (a / 2))].

Lemma Qx_represents : forall a, represents (Qx a) (Rx a).
Proof. intro a. unfold Qx. split; [|intro v]; spread; by_half_angle a. Qed.

Lemma Qy_represents : forall a, represents (Qy a) (Ry a).
Proof. intro a. unfold Qy. split; [|intro v]; spread; by_half_angle a. Qed.

Lemma Qz_represents : forall a, represents (Qz a) (Rz a).
Proof. intro a. unfold Qz. split; [|intro v]; spread; by_half_angle a. Qed.

Definition turn (q : quaternion) : matrix :=
  mat (1 - 2 * (h2 q * h2 q + h3 q * h3 q)) (2 * (h1 q * h2 q - h0 q * h3 q)) (2 * (h1 q * h3 q + h0 q * h2 q))
      (2 * (h1 q * h2 q + h0 q * h3 q)) (1 - 2 * (h1 q * h1 q + h3 q * h3 q)) (2 * (h2 q * h3 q - h0 q * h1 q))
      (2 * (h1 q * h3 q - h0 q * h2 q)) (2 * (h2 q * h3 q + h0 q * h1 q)) (1 - 2 * (h1 q * h1 q + h2 q * h2 q)).

Lemma norm2_square : forall q, norm2 q = 1 -> h0 q * h0 q = 1 - h1 q * h1 q - h2 q * h2 q - h3 q * h3 q.
Proof. intros q H. rewrite <- H. unfold norm2. ring. Qed.

Ltac by_norm N := (* equal components, for a quaternion of unit norm *)
  unfold turn; spread; try f_equal; ring [N].

Lemma turn_represents : forall q, norm2 q = 1 -> represents q (turn q).
Proof.
  intros q H. split; [exact H|]. intro v. pose proof (norm2_square q H) as N. destruct q. cbn in N. by_norm N.
Qed.

Lemma pure_injective : forall v w, pure v = pure w -> v = w.
Proof. intros [a b c] [d e f] H. injection H. intros. subst. reflexivity. Qed.

Lemma turn_only : forall q a, represents q a -> a = turn q.
Proof.
  intros q a [H K]. destruct (turn_represents q H) as [_ T].
  assert (E : forall v, a *v v = turn q *v v) by (intro v; apply pure_injective; rewrite <- K; apply T).
  pose proof (E (vec 1 0 0)) as E1. pose proof (E (vec 0 1 0)) as E2. pose proof (E (vec 0 0 1)) as E3.
  destruct a, (turn q). unfold mulv in E1, E2, E3. cbn in E1, E2, E3. injection E1. injection E2. injection E3.
  intros. f_equal; lra.
Qed.

Lemma turn_rotation : forall q, norm2 q = 1 -> rotation (turn q).
Proof.
  intros q H. pose proof (norm2_square q H) as N. destruct q. cbn in N.
  split; by_norm N.
Qed.

Lemma represents_rotation : forall q a, represents q a -> rotation a.
Proof. intros q a H. rewrite (turn_only q a H). apply turn_rotation. exact (proj1 H). Qed.

Lemma turn_body : forall q0 q1 q2 q3 t dq0 dq1 dq2 dq3 v,
  derivable_pt_lim q0 t dq0 -> derivable_pt_lim q1 t dq1 -> derivable_pt_lim q2 t dq2 -> derivable_pt_lim q3 t dq3 ->
  norm2 (quat (q0 t) (q1 t) (q2 t) (q3 t)) = 1 ->
  quat dq0 dq1 dq2 dq3 = quat (q0 t) (q1 t) (q2 t) (q3 t) *q pure v ->
  derivative (fun u => turn (quat (q0 u) (q1 u) (q2 u) (q3 u))) t
    (turn (quat (q0 t) (q1 t) (q2 t) (q3 t)) *m skew (vadd v v)).
Proof.
  intros q0 q1 q2 q3 t dq0 dq1 dq2 dq3 v D0 D1 D2 D3 H E. pose proof (norm2_square _ H) as N. clear H. cbn in N.
  revert E. spread. intro E. injection E. clear E. intros E3 E2 E1 E0. unfold turn.
  unfold derivative; spread; repeat match goal with |- _ /\ _ => split end;
    (eapply derivative_is; [differentiate | cbv beta; rewrite ?E0, ?E1, ?E2, ?E3; ring [N]]).
Qed.

Lemma turn_space : forall q0 q1 q2 q3 t dq0 dq1 dq2 dq3 v,
  derivable_pt_lim q0 t dq0 -> derivable_pt_lim q1 t dq1 -> derivable_pt_lim q2 t dq2 -> derivable_pt_lim q3 t dq3 ->
  norm2 (quat (q0 t) (q1 t) (q2 t) (q3 t)) = 1 ->
  quat dq0 dq1 dq2 dq3 = pure v *q quat (q0 t) (q1 t) (q2 t) (q3 t) ->
  derivative (fun u => turn (quat (q0 u) (q1 u) (q2 u) (q3 u))) t
    (skew (vadd v v) *m turn (quat (q0 t) (q1 t) (q2 t) (q3 t))).
Proof.
  intros q0 q1 q2 q3 t dq0 dq1 dq2 dq3 v D0 D1 D2 D3 H E. pose proof (norm2_square _ H) as N. clear H. cbn in N.
  revert E. spread. intro E. injection E. clear E. intros E3 E2 E1 E0. unfold turn.
  unfold derivative; spread; repeat match goal with |- _ /\ _ => split end;
    (eapply derivative_is; [differentiate | cbv beta; rewrite ?E0, ?E1, ?E2, ?E3; ring [N]]).
Qed.

Definition vector_part (q : quaternion) : vector := vec (h1 q) (h2 q) (h3 q).

Lemma quat_path_norm : forall q0 q1 q2 q3 t dq0 dq1 dq2 dq3,
  derivable_pt_lim q0 t dq0 -> derivable_pt_lim q1 t dq1 -> derivable_pt_lim q2 t dq2 -> derivable_pt_lim q3 t dq3 ->
  (forall u, norm2 (quat (q0 u) (q1 u) (q2 u) (q3 u)) = 1) ->
  q0 t * dq0 + q1 t * dq1 + q2 t * dq2 + q3 t * dq3 = 0.
Proof.
  intros q0 q1 q2 q3 t dq0 dq1 dq2 dq3 D0 D1 D2 D3 U.
  assert (Y : derivable_pt_lim (fun u => norm2 (quat (q0 u) (q1 u) (q2 u) (q3 u))) t
    (2 * (q0 t * dq0 + q1 t * dq1 + q2 t * dq2 + q3 t * dq3)))
    by (spread; eapply derivative_is; [differentiate | cbv beta; ring]).
  assert (Z : derivable_pt_lim (fun u => norm2 (quat (q0 u) (q1 u) (q2 u) (q3 u))) t 0)
    by (apply (d_same _ (fun _ => 1)); [exact U | apply d_constant]).
  pose proof (uniqueness_limite _ _ _ _ Z Y). lra.
Qed.

Lemma scaled_rate : forall q r, norm2 q = 1 -> h0 q * h0 r + h1 q * h1 r + h2 q * h2 r + h3 q * h3 r = 0 ->
  r = q *q pure (vector_part (conjugate q *q r)) /\ r = pure (vector_part (r *q conjugate q)) *q q.
Proof.
  intros q r N S. assert (N' := norm2_square q N). clear N. destruct q as [a b c d], r as [e f g h]. cbn in N', S.
  assert (B : conjugate (quat a b c d) *q quat e f g h =
    pure (vector_part (conjugate (quat a b c d) *q quat e f g h))).
  { unfold vector_part. spread. f_equal. rewrite <- S. ring. }
  assert (C : quat e f g h *q conjugate (quat a b c d) =
    pure (vector_part (quat e f g h *q conjugate (quat a b c d)))).
  { unfold vector_part. spread. f_equal. rewrite <- S. ring. }
  rewrite <- B, <- C. split; spread; f_equal; ring [N'].
Qed.

Lemma only_quaternion_rates_body : forall q0 q1 q2 q3 t dq0 dq1 dq2 dq3 omega,
  derivable_pt_lim q0 t dq0 -> derivable_pt_lim q1 t dq1 -> derivable_pt_lim q2 t dq2 -> derivable_pt_lim q3 t dq3 ->
  (forall u, norm2 (quat (q0 u) (q1 u) (q2 u) (q3 u)) = 1) ->
  derivative (fun u => turn (quat (q0 u) (q1 u) (q2 u) (q3 u))) t
    (turn (quat (q0 t) (q1 t) (q2 t) (q3 t)) *m skew omega) ->
  exists v, omega = vadd v v /\ quat dq0 dq1 dq2 dq3 = quat (q0 t) (q1 t) (q2 t) (q3 t) *q pure v.
Proof.
  intros q0 q1 q2 q3 t dq0 dq1 dq2 dq3 omega D0 D1 D2 D3 U H.
  pose proof (quat_path_norm _ _ _ _ _ _ _ _ _ D0 D1 D2 D3 U) as S.
  destruct (scaled_rate (quat (q0 t) (q1 t) (q2 t) (q3 t)) (quat dq0 dq1 dq2 dq3) (U t) S) as [P _].
  eexists. split; [|exact P].
  apply (body_skew_injective _ _ _ (turn_rotation _ (U t))).
  exact (derivative_unique _ _ _ _ H (turn_body _ _ _ _ _ _ _ _ _ _ D0 D1 D2 D3 (U t) P)).
Qed.

Lemma only_quaternion_rates_space : forall q0 q1 q2 q3 t dq0 dq1 dq2 dq3 omega,
  derivable_pt_lim q0 t dq0 -> derivable_pt_lim q1 t dq1 -> derivable_pt_lim q2 t dq2 -> derivable_pt_lim q3 t dq3 ->
  (forall u, norm2 (quat (q0 u) (q1 u) (q2 u) (q3 u)) = 1) ->
  derivative (fun u => turn (quat (q0 u) (q1 u) (q2 u) (q3 u))) t
    (skew omega *m turn (quat (q0 t) (q1 t) (q2 t) (q3 t))) ->
  exists v, omega = vadd v v /\ quat dq0 dq1 dq2 dq3 = pure v *q quat (q0 t) (q1 t) (q2 t) (q3 t).
Proof.
  intros q0 q1 q2 q3 t dq0 dq1 dq2 dq3 omega D0 D1 D2 D3 U H.
  pose proof (quat_path_norm _ _ _ _ _ _ _ _ _ D0 D1 D2 D3 U) as S.
  destruct (scaled_rate (quat (q0 t) (q1 t) (q2 t) (q3 t)) (quat dq0 dq1 dq2 dq3) (U t) S) as [_ P].
  eexists. split; [|exact P].
  apply (space_skew_injective _ _ _ (turn_rotation _ (U t))).
  exact (derivative_unique _ _ _ _ H (turn_space _ _ _ _ _ _ _ _ _ _ D0 D1 D2 D3 (U t) P)).
Qed.

(* --- angular momentum --- *)

Lemma momentum_rate : forall D i omega t domega, (* d(R L)/dt = R (dL/dt + omega x L), for L = I omega *)
  derivative D t (D t *m skew (omega t)) -> vderivative omega t domega ->
  vderivative (fun u => D u *v (i *v omega u)) t (D t *v vadd (i *v domega) (cross (omega t) (i *v omega t))).
Proof.
  intros D i omega t domega H K. assert (L : vderivative (fun u => i *v omega u) t (i *v domega)).
  { unfold vderivative in K. decompose [and] K. clear K. entry_by_entry. }
  pose proof (d_mulv _ _ _ _ _ H L) as P. cbv beta in P. revert P.
  replace (vadd (D t *m skew (omega t) *v (i *v omega t)) (D t *v (i *v domega)))
    with (D t *v vadd (i *v domega) (cross (omega t) (i *v omega t))) by by_ring.
  trivial.
Qed.

Lemma msub_mmul_skew : forall a b w, msub a (b *m skew w) = madd a (b *m transpose (skew w)).
Proof. intros. by_ring. Qed.

Lemma madd_zero : forall a b, madd a (b *m mat 0 0 0 0 0 0 0 0 0) = a.
Proof. intros [] b. by_ring. Qed.

Lemma turned_tensor_rate : forall D i t w, derivative D t (skew w *m D t) ->
  let turned := D t *m i *m transpose (D t) in
  derivative (fun u => D u *m i *m transpose (D u)) t (msub (skew w *m turned) (turned *m skew w)).
Proof.
  intros D i t w H turned. unfold turned. rewrite msub_mmul_skew, <- !mmul_assoc.
  rewrite (mmul_assoc (D t *m i)), <- transpose_mmul, <- (madd_zero (skew w *m D t *m i) (D t)).
  apply (d_mmul (fun u => D u *m i) (fun u => transpose (D u))).
  - apply (d_mmul D (fun _ => i)); [exact H | repeat split; apply d_constant].
  - apply d_transpose. exact H.
Qed.

Lemma vderivative_unique : forall f t d e, vderivative f t d -> vderivative f t e -> d = e.
Proof.
  intros f t [] []. unfold vderivative. spread. intros H K. decompose [and] H. decompose [and] K.
  f_equal; eapply uniqueness_limite; eassumption.
Qed.

Lemma rotation_injective : forall a v w, rotation a -> a *v v = a *v w -> v = w.
Proof.
  intros a v w [A _] H. rewrite <- (identity_mulv v), <- (identity_mulv w), <- A, !mulv_mmul, H. reflexivity.
Qed.

Lemma cross_beyond : forall v w u x, vadd v (cross w u) = x <-> v = vadd x (cross u w).
Proof.
  intros [v1 v2 v3] [w1 w2 w3] [u1 u2 u3] [y1 y2 y3]. spread.
  split; intro H; injection H; intros; subst; f_equal; ring.
Qed.

Lemma only_acceleration : forall D i omega t domega tau rates,
  derivative D t (D t *m skew (omega t)) -> vderivative omega t domega -> rotation (D t) -> det i <> 0 ->
  i *v rates = vadd tau (cross (i *v omega t) (omega t)) ->
  (vderivative (fun u => D u *v (i *v omega u)) t (D t *v tau) <-> domega = rates).
Proof.
  intros D i omega t domega tau rates H K N I E. pose proof (momentum_rate D i omega t domega H K) as P.
  split; intro Q.
  - apply (mulv_injective i _ _ I). rewrite E. apply cross_beyond. apply (rotation_injective _ _ _ N).
    exact (vderivative_unique _ _ _ _ P Q).
  - rewrite <- Q in E. apply cross_beyond in E. rewrite E in P. exact P.
Qed.
