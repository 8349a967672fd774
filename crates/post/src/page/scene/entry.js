// What scene.js uses of three.js; esbuild leaves the rest out.
export {
  AmbientLight, BackSide, BufferAttribute, BufferGeometry, Color, DataTexture, DirectionalLight, DoubleSide,
  DynamicDrawUsage, Group, InstancedMesh, LinearFilter, LineBasicMaterial, LineSegments, Matrix4, Mesh,
  MeshBasicMaterial, MeshLambertMaterial, PerspectiveCamera, Plane, Raycaster, Scene, SRGBColorSpace, Vector2, Vector3,
  WebGLRenderer,
} from 'three';
export { OrbitControls } from 'three/addons/controls/OrbitControls.js';
