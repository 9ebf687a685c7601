/* SPDX-License-Identifier: Apache-2.0 */
/* The model in the page of `parhelion equip`: unpacked, drawn by three.js when something has
   changed, turned by mouse, fingers and keys, and asked what lies under a pixel. */
var equipView=(function(){
var data=JSON.parse(document.getElementById('equip-data').textContent);
var canvas=document.getElementById('canvas');
var MARK=[0.95,0.25,0.05],LIT=[0.1,0.45,1],CLICK_PIXELS=5,LEAST_M=0.02;
/* onpress says whether a drag from there is somebody's: ondrag and ondrop then hear of it. */
var view={data:data,canvas:canvas,onclick:null,onlook:null,onpress:null,ondrag:null,ondrop:null,
  hidden:new Set(),isClear:false};

/* ---- the numbers (page_data.h) ---- */
function bytesOf(text){
  var digits=atob(text),out=new Uint8Array(digits.length);
  for(var i=0;i<out.length;i++)out[i]=digits.charCodeAt(i);
  return out;
}
async function unpack(id,count,bytes){
  var block=document.getElementById(id);
  var stream=new Blob([bytesOf(block.textContent)]).stream()
    .pipeThrough(new DecompressionStream('deflate'));
  var planes=new Uint8Array(await new Response(stream).arrayBuffer());
  var out=new Uint32Array(count);
  block.remove();
  for(var plane=0;plane<bytes;plane++)
    for(var i=0,at=plane*count,value=0;i<count;i++,at++){
      value=value+planes[at]&255;
      out[i]|=value<<8*plane;
    }
  return out;
}
async function unpackModel(){
  var steps=[];
  for(var name of ['x','y','z'])steps.push(await unpack('equip-'+name,data.vertices,3));
  view.steps=steps;
  view.position=new Float32Array(3*data.vertices);
  for(var a=0;a<3;a++){
    var size=data.high[a]-data.low[a];
    for(var i=0;i<data.vertices;i++)
      view.position[3*i+a]=data.low[a]+size*steps[a][i]/16777215;
  }
  view.uv=new Float32Array(2*data.vertices);
  for(var w of [0,1]){
    var block=document.getElementById('equip-'+'uv'[w]),low=+block.dataset.low;
    var scale=block.dataset.size/16777215,codes=await unpack(block.id,data.vertices,3);
    for(var k=0;k<data.vertices;k++)view.uv[2*k+w]=low+scale*codes[k];
  }
  view.index=await unpack('equip-i',3*data.triangles,data.index_bytes);
  view.partOf=new Uint32Array(data.triangles);
  data.parts.forEach(function(part,p){
    view.partOf.fill(p,part.first,part.first+part.count);
  });
}

/* ---- what is drawn ---- */
var renderer,scene=new THREE.Scene(),camera=new THREE.PerspectiveCamera(50,1,0.01,1000);
var meshes=[],materials=[],textures=[],waiting=false;
var marks=new THREE.Group();
view.marks=marks;

function textureOf(id){
  if(id<0||!data.textures[id])return null;
  if(!textures[id]){
    textures[id]=new THREE.TextureLoader().load(data.textures[id],view.draw);
    textures[id].flipY=false;
    textures[id].encoding=THREE.sRGBEncoding;
    textures[id].wrapS=textures[id].wrapT=THREE.RepeatWrapping;
  }
  return textures[id];
}
function addMaterials(){
  data.materials.forEach(function(m){
    var clear=m.alpha<1;
    materials.push(new THREE.MeshPhongMaterial({side:THREE.DoubleSide,flatShading:true,
      shininess:8,specular:0x080808,transparent:clear,opacity:m.alpha,depthWrite:!clear,
      polygonOffset:true,polygonOffsetFactor:1,polygonOffsetUnits:1}));
  });
}
/* Its parts but the hidden ones. */
function fillMesh(mesh){
  var parts=data.parts.filter(function(part,p){
    return (data.materials[part.material].alpha<1)===mesh.isGlass&&!view.hidden.has(p);
  }).sort(function(a,b){return a.material-b.material;});
  var triangles=[],geometry=mesh.geometry;
  geometry.clearGroups();
  parts.forEach(function(part){
    geometry.addGroup(3*triangles.length,3*part.count,part.material);
    for(var t=part.first;t<part.first+part.count;t++)triangles.push(t);
  });
  var index=new Uint32Array(3*triangles.length);
  triangles.forEach(function(t,i){index.set(view.index.subarray(3*t,3*t+3),3*i);});
  geometry.setIndex(new THREE.BufferAttribute(index,1));
  mesh.triangles=triangles;
  mesh.visible=triangles.length>0;
}
/* Glass is drawn clear, and a click goes through it to what is behind. */
function addMesh(isGlass){
  var geometry=new THREE.BufferGeometry(),mesh=new THREE.Mesh(geometry,materials);
  geometry.setAttribute('position',new THREE.BufferAttribute(view.position,3));
  geometry.setAttribute('uv',new THREE.BufferAttribute(view.uv,2));
  mesh.isGlass=isGlass;
  fillMesh(mesh);
  scene.add(mesh);
  meshes.push(mesh);
}
/* What is hidden is neither seen nor clicked. */
view.hide=function(part){
  if(part===null)view.hidden.clear();
  else view.hidden.add(part);
  meshes.forEach(fillMesh);
  view.draw();
};
/* As if all were of glass; clicks still meet it. */
view.clear=function(isClear){
  view.isClear=isClear;
  materials.forEach(function(m,id){
    var alpha=isClear?Math.min(0.3,data.materials[id].alpha):data.materials[id].alpha;
    m.opacity=alpha;
    m.transparent=alpha<1;
    m.depthWrite=alpha>=1;
    m.needsUpdate=true;
  });
  view.draw();
};
/* colourOf: a material's colour where something else is said of it, null where it stays. */
view.paint=function(colourOf){
  data.materials.forEach(function(m,id){
    var own=colourOf(id),map=own?null:textureOf(m.texture);
    materials[id].color.setRGB(...(own||(map?m.factor:m.color)));
    if(materials[id].map!==map)materials[id].needsUpdate=true;
    materials[id].map=map;
  });
  view.draw();
};
view.MARK=MARK;
view.LIT=LIT;

/* Corners of a rectangle that is being drawn; null: none is. */
var outline=null;
view.outline=function(corners){
  if(outline)scene.remove(outline);
  outline=corners&&new THREE.LineLoop(new THREE.BufferGeometry().setFromPoints(corners),
    new THREE.LineBasicMaterial({color:0xff8a1f,depthTest:false}));
  if(outline)scene.add(outline);
  view.draw();
};
function addLights(){
  scene.add(new THREE.HemisphereLight(0xffffff,0x8a8f96,0.75));
  var lamp=new THREE.DirectionalLight(0xffffff,0.45);
  camera.add(lamp);
  lamp.position.set(0.4,0.6,1);
  scene.add(camera);
  scene.add(marks);
}
view.draw=function(){
  if(waiting||!renderer)return;
  waiting=true;
  requestAnimationFrame(function(){
    waiting=false;
    place();
    if(view.onlook)view.onlook(camera);
    renderer.render(scene,camera);
    canvas.dataset.drawn=+(canvas.dataset.drawn||0)+1;
  });
};
function resize(){
  var width=canvas.clientWidth,height=canvas.clientHeight;
  if(!width||!height)return;
  renderer.setPixelRatio(window.devicePixelRatio||1);
  renderer.setSize(width,height,false);
  camera.aspect=width/height;
  camera.updateProjectionMatrix();
  view.draw();
}

/* ---- where it is seen from: about a place, by two angles and a distance ---- */
var about=new THREE.Vector3(),turn=0.6,lean=0.35,away=3;
function direction(){
  return new THREE.Vector3(Math.sin(turn)*Math.cos(lean),Math.sin(lean),
    Math.cos(turn)*Math.cos(lean));
}
function place(){
  camera.position.copy(about).addScaledVector(direction(),away);
  camera.lookAt(about);
  camera.near=Math.max(0.003,away/400);
  camera.far=Math.max(20*away,4*view.size);
  camera.updateProjectionMatrix();
  camera.updateMatrixWorld();
}
view.look=function(from,to,fov){
  var d=from.clone().sub(to);
  about.copy(to);
  away=Math.max(LEAST_M,d.length());
  turn=Math.atan2(d.x,d.z);
  lean=Math.asin(Math.max(-1,Math.min(1,d.y/away)));
  camera.fov=fov||50;
  view.draw();
};
view.all=function(t,l){
  about.copy(view.middle);
  turn=t;lean=l;
  camera.fov=50;
  away=0.62*view.size/Math.tan(25*Math.PI/180)/Math.min(1,camera.aspect);
  view.draw();
};
function spin(dx,dy){
  turn-=dx;
  lean=Math.max(-1.57,Math.min(1.57,lean+dy));
  view.draw();
}
function pan(dx,dy){
  var scale=2*away*Math.tan(camera.fov*Math.PI/360)/canvas.clientHeight;
  var e=camera.matrixWorld.elements;
  about.x-=scale*(dx*e[0]-dy*e[4]);
  about.y-=scale*(dx*e[1]-dy*e[5]);
  about.z-=scale*(dx*e[2]-dy*e[6]);
  view.draw();
}
/* Nearer than that one goes ahead, through what is there. */
function zoom(factor){
  if(away*factor<LEAST_M)about.addScaledVector(direction(),-away*(1-factor));
  else away*=factor;
  view.draw();
}

/* ---- what is under a pixel ---- */
var caster=new THREE.Raycaster();
view.ray=function(x,y){
  var box=canvas.getBoundingClientRect();
  place();
  caster.setFromCamera(new THREE.Vector2(2*(x-box.left)/box.width-1,
    1-2*(y-box.top)/box.height),camera);
  return caster.ray;
};
/* Where a pixel's ray meets a plane; null: it does not. */
view.onPlane=function(x,y,point,normal){
  return view.ray(x,y).intersectPlane(
    new THREE.Plane().setFromNormalAndCoplanarPoint(normal,point),new THREE.Vector3());
};
view.pick=function(x,y){
  view.ray(x,y);
  for(var mesh of meshes){
    var hits=mesh.triangles.length?caster.intersectObject(mesh):[];
    if(!hits.length)continue;
    var normal=hits[0].face.normal.clone();
    if(normal.dot(caster.ray.direction)>0)normal.negate();
    return {triangle:mesh.triangles[hits[0].faceIndex],point:hits[0].point,normal:normal,
      from:camera.position.clone()};
  }
  return null;
};
view.project=function(point){
  var box=canvas.getBoundingClientRect();
  place();
  var v=new THREE.Vector3(point[0],point[1],point[2]).project(camera);
  return [box.left+(v.x+1)/2*box.width,box.top+(1-v.y)/2*box.height];
};

/* ---- hands ---- */
var fingers=new Map(),moved=0,isTheirs=false;
function spread(){
  var f=[...fingers.values()];
  return {x:(f[0].x+f[1].x)/2,y:(f[0].y+f[1].y)/2,d:Math.hypot(f[0].x-f[1].x,f[0].y-f[1].y)};
}
canvas.addEventListener('pointerdown',function(e){
  canvas.setPointerCapture(e.pointerId);
  if(!fingers.size){
    moved=0;
    isTheirs=e.button===0&&!e.shiftKey&&!!view.onpress&&view.onpress(e.clientX,e.clientY);
  }
  fingers.set(e.pointerId,{x:e.clientX,y:e.clientY});
});
canvas.addEventListener('pointermove',function(e){
  var was=fingers.get(e.pointerId);
  if(!was)return;
  var before=fingers.size===2?spread():null,dx=e.clientX-was.x,dy=e.clientY-was.y;
  moved+=Math.abs(dx)+Math.abs(dy);
  fingers.set(e.pointerId,{x:e.clientX,y:e.clientY});
  if(moved<=CLICK_PIXELS)return;
  if(isTheirs){view.ondrag(e.clientX,e.clientY);return;}
  if(before){
    var now=spread();
    pan(now.x-before.x,now.y-before.y);
    zoom(before.d/Math.max(1,now.d));
  }else if(e.buttons&2||e.buttons&4||e.shiftKey)pan(dx,dy);
  else spin(dx*0.006,dy*0.006);
});
function lift(e){
  var was=fingers.delete(e.pointerId),held=isTheirs&&moved>CLICK_PIXELS;
  if(was&&!fingers.size&&held)view.ondrop(e.clientX,e.clientY);
  if(was&&!fingers.size&&moved<=CLICK_PIXELS&&e.type==='pointerup'){
    var hit=view.pick(e.clientX,e.clientY);
    if(e.button===0&&view.onclick)view.onclick(hit);
    if(e.button===2&&hit)view.look(camera.position,hit.point,camera.fov);
  }
  if(fingers.size)moved=CLICK_PIXELS+1;
}
canvas.addEventListener('pointerup',lift);
canvas.addEventListener('pointercancel',lift);
canvas.addEventListener('contextmenu',function(e){e.preventDefault();});
canvas.addEventListener('wheel',function(e){
  e.preventDefault();
  zoom(Math.exp(Math.max(-1,Math.min(1,e.deltaY/400))));
},{passive:false});
var KEYS={ArrowLeft:[1,0],ArrowRight:[-1,0],ArrowUp:[0,1],ArrowDown:[0,-1]};
canvas.addEventListener('keydown',function(e){
  var way=KEYS[e.key];
  if(way&&e.shiftKey)pan(30*way[0],30*way[1]);
  else if(way)spin(0.08*way[0],0.08*way[1]);
  else if(e.key==='+'||e.key==='=')zoom(0.85);
  else if(e.key==='-')zoom(1/0.85);
  else return;
  e.preventDefault();
});

view.start=async function(){
  await unpackModel();
  var low=new THREE.Vector3(...data.low),high=new THREE.Vector3(...data.high);
  view.middle=low.clone().add(high).multiplyScalar(0.5);
  view.size=high.distanceTo(low)||1;
  renderer=new THREE.WebGLRenderer({canvas:canvas,antialias:true,alpha:true});
  renderer.gammaOutput=true;
  addMaterials();
  addMesh(false);
  addMesh(true);
  addLights();
  new ResizeObserver(resize).observe(canvas);
  resize();
};
return view;
})();
