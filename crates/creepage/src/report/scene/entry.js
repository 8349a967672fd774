// What scene.js uses of three.js; esbuild leaves the rest out.
export {
  AlwaysStencilFunc, AmbientLight, BackSide, BufferAttribute, BufferGeometry, DataTexture, DecrementWrapStencilOp,
  DirectionalLight, DoubleSide, DynamicDrawUsage, FrontSide, Group, IncrementWrapStencilOp, InstancedMesh, LinearFilter,
  LineBasicMaterial, LineSegments, Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial, NotEqualStencilFunc,
  PerspectiveCamera, Plane, PlaneGeometry, Raycaster, Scene, SRGBColorSpace, Vector2, Vector3, WebGLRenderer,
} from 'three';
export { OrbitControls } from 'three/addons/controls/OrbitControls.js';
