export {
    ArrowHelper, BufferAttribute, BufferGeometry, CatmullRomCurve3, ConeGeometry, DirectionalLight, DoubleSide,
    EdgesGeometry, GridHelper, Group, HemisphereLight, Line, LineBasicMaterial, LineSegments, Matrix4, Mesh,
    MeshStandardMaterial, PerspectiveCamera, Quaternion, RingGeometry, Scene, SphereGeometry, TubeGeometry, Vector3,
    WebGLRenderer,
} from "three";
export { OrbitControls } from "three/addons/controls/OrbitControls.js";
export { default as uPlot } from "uplot";
